// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapted_boundary.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/adapt.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/spatial_mesh.h"

#include <optional>
#include <span>
#include <vector>

namespace slabhull {

/// A terminating cap made by moving the initial one and changing its connectivity layer by layer.
template<int D>
struct AdaptedCap {
    CapMesh<D> mesh;           ///< swept vertices first, as a mesher gives them
    std::vector<Index> column; ///< of each of its vertices
    AdaptLog<D> log;           ///< `tracks` are those of the initial cap; later columns have none yet
    Index columns = 0;         ///< how many there are
    AdaptReport report;
    std::optional<LayeredSweep<D>> side; ///< of a boundary whose connectivity was changed
};

/// A cap has cells that its motion turns inside out within a layer, or its boundary crosses itself when it is
/// changed.
class InvertedCap : public GeometryError {
public:
    using GeometryError::GeometryError;
};

/// The moving boundary of a cap.
template<int D>
struct CapBoundary {
    std::span<const Index> vertices;               ///< the initial cap's
    const std::vector<double>& times;              ///< of the levels
    const std::vector<Array<Point<D>>>& positions; ///< by level, then as `vertices`
    std::span<const double> spacing;               ///< target length of edges at each
    const BoundaryMotion<D>* motion = nullptr;     ///< what moves it if AdaptOptions::boundary is set
};

/// Moves the initial cap from level to level (move_cap()), improves its vertices' places, and makes a round
/// of operations in each layer. `tracks` are those of all its vertices. Throws InvertedCap naming the
/// vertices of cells that cannot be kept positive. Cost: per layer that of move_cap(), two or three passes
/// over the cells, and some 10 to 100 microseconds for each cell that asks for an operation. The same for any
/// number of threads.
template<int D>
AdaptedCap<D> adapt_cap(const SpatialMesh<D>& initial, std::span<const TrackId> tracks,
                        const CapBoundary<D>& boundary, const AdaptOptions& options);

/// Gives the vertices made by operations their tracks: ascending from `first`.
template<int D>
void give_new_tracks(TrackId first, Index columns, AdaptLog<D>& log);

/// The log of an adapted slab, found by adapting its initial cap again. Throws GeometryError when that does
/// not lead to the hull's terminating cap.
template<int D>
AdaptLog<D> log_of_hull(const Hull<D>& hull);

} // namespace slabhull
