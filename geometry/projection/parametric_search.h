// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace slabhull::detail {

/// A point of a surface S(u, v) with its derivatives.
struct SurfaceJet {
    Point<3> value{};
    Point<3> du{};
    Point<3> dv{};
    Point<3> duu{};
    Point<3> duv{};
    Point<3> dvv{};
};

/// Finds the closest points of a parametric surface over a rectangle: Newton's method from each sample of a
/// grid that is closer than its neighbours, the closest first. Minima that the grid does not resolve may be
/// missed.
class ParametricSearch {
public:
    using Parameters = std::array<double, 2>;
    using Surface = std::function<SurfaceJet(const Parameters&)>;

    /// Called for each foot. Returns the distance beyond which feet are no longer of interest.
    using Visit = std::function<double(const Parameters&, const Point<3>& foot, double distance)>;

    /// Needs: at least 2 samples in each direction.
    ParametricSearch(Surface surface, const Parameters& low, const Parameters& high,
                     const std::array<std::size_t, 2>& samples);

    /// Visits the local minima of the distance to x that may be nearer than `limit`, those on the rectangle's
    /// rim included. Each visit may lower `limit`.
    void visit_feet(const Point<3>& x, double limit, const Visit& visit);

private:
    Parameters parameters(std::size_t sample) const;
    bool locally_closest(std::size_t sample) const;
    Parameters descend(const Point<3>& x, Parameters at) const;

    Surface surface_;
    Parameters low_;
    Parameters high_;
    std::array<std::size_t, 2> samples_;
    std::vector<Point<3>> points_;    ///< by sample, u running fastest
    std::vector<double> reach_;       ///< of each sample: distance to its farthest neighbour
    std::vector<double> distances_;   ///< from the queried point to each sample
    std::vector<std::size_t> starts_; ///< samples to start from
};

} // namespace slabhull::detail
