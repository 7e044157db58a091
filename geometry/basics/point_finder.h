// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"
#include "slabhull/core/vector.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Finds the points within a small radius. They are sorted along a direction that is oblique to the usual
/// planes and grids, so that few points share a position on it.
template<int D>
class PointFinder {
public:
    /// The points must outlive the finder. Cost: that of sorting.
    explicit PointFinder(std::span<const Point<D>> points);

    /// The points at most `radius` from x: by distance, then by number.
    /// Cost: that of a search, plus linear in the points within `radius` along the direction.
    std::vector<std::size_t> within(const Point<D>& x, double radius) const;

    /// The nearest of all. Needs: a point. Cost: linear.
    std::size_t nearest(const Point<D>& x) const;

private:
    struct Place {
        double along;
        std::size_t point;
    };
    std::span<const Point<D>> points_;
    std::vector<Place> places_; ///< ascending along the direction
};

extern template class PointFinder<2>;
extern template class PointFinder<3>;

} // namespace slabhull
