// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/boundary.h"

#include <vector>

namespace slabhull {

/// A change of the boundary's connectivity within a patch in a layer: facets at its start become others at
/// its end, around the same ridges. The hull's side there is a cone.
template<int D>
struct BoundaryChange {
    std::vector<Index> removed;  ///< facets of the boundary at the layer's start
    std::vector<Facet<D>> added; ///< vertices as columns, outward
    PatchNumber patch = 0;
    Point<D + 1> apex{};
};

template<int D>
struct SideLayer {
    Boundary<D> boundary;       ///< at the layer's start
    std::vector<Index> columns; ///< of its vertices
    Array<Point<D>> end;        ///< their places at the layer's end, also of those that end before
    std::vector<BoundaryChange<D>> changes; ///< share no facet
};

/// A moving boundary whose connectivity changes from layer to layer.
template<int D>
struct LayeredSweep {
    std::vector<double> times;
    std::vector<SideLayer<D>> layers;
    std::vector<Array<Point<D>>> places; ///< by level: of the vertices of its boundary
    Boundary<D> last;                    ///< the boundary at the last level ...
    std::vector<Index> last_columns;     ///< ... and the columns of its vertices
};

} // namespace slabhull
