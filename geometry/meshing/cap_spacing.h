// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/box_tree.h"

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/spatial_mesh.h"

#include <functional>
#include <optional>
#include <vector>

namespace slabhull {

/// Spacing for the triangles of a planar domain whose boundary edges must not be split: the wanted spacing,
/// raised around boundary edges that are much longer. A triangle on such an edge is as large as the edge, and
/// has neighbours with good angles only if their size grows towards it.
class CapSpacing {
public:
    using Wanted = std::function<double(const Point<2>&)>;

    /// `growth`: largest increase of the wanted spacing per unit of distance.
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
    std::optional<BoxTree<2>> reach_;      ///< region of influence of each long edge
    std::optional<SizeField<2>> steepest_; ///< upper bound, due to short edges nearby
};

} // namespace slabhull
