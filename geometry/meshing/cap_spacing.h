// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/box_tree.h"

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/spatial_mesh.h"

#include <functional>
#include <optional>
#include <vector>

namespace slabhull {

/// Spacing for the triangles of a planar domain whose boundary edges must not be split: what is wanted,
/// raised around boundary edges that are much longer than it. A triangle on such an edge is as large as the
/// edge, whatever is wanted there, and only neighbours that grow to meet it have good angles.
class CapSpacing {
public:
    using Wanted = std::function<double(const Point<2>&)>;

    /// `growth` is how fast the wanted spacing grows at most per unit of distance.
    CapSpacing(const Surface<2>& boundary, Wanted wanted, double growth);

    double operator()(const Point<2>& x) const {
        const double wanted = wanted_(x);
        return long_edges_.empty() ? wanted : raised(x, wanted);
    }

private:
    struct LongEdge {
        Point<2> middle;
        double size; ///< spacing at its middle
    };

    void find_long_edges(const Surface<2>& boundary);
    double raised(const Point<2>& x, double wanted) const;

    Wanted wanted_;
    std::vector<LongEdge> long_edges_;
    std::optional<BoxTree<2>> reach_;      ///< where each long edge counts
    std::optional<SizeField<2>> steepest_; ///< what short edges nearby allow
};

} // namespace slabhull
