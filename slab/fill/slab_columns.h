// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/filling.h"
#include "slabhull/topology/hull.h"

#include <cstdint>
#include <vector>

namespace slabhull {

/// The mesh that both caps share, with the filling's vertices on every level. A column is one vertex of that
/// mesh on all levels. Columns are numbered by ascending track, so a prism's diagonals follow from the
/// numbers.
template<int D>
struct SlabColumns {
    std::vector<double> times;       ///< of the levels
    std::size_t count = 0;           ///< number of columns
    Array<Index> vertex;             ///< the filling's vertex at [level * count + column]
    Array<std::uint8_t> on_boundary; ///< of each column: whether it is on the hull

    Array<Simplex<D>> cells;       ///< those of the initial cap, in its order, each with ascending columns
    Array<std::uint8_t> odd;       ///< of each cell: whether ascending columns make it negative in space
    Array<Neighbors<D>> neighbors; ///< across the facet opposite to the k-th column; no_index on the boundary
    /// The swept facet opposite to each column of each cell; no_index inside.
    Array<Neighbors<D>> swept_facet;

    std::size_t layers() const { return times.size() - 1; }
    Index at(std::size_t level, Index column) const { return vertex[level * count + column]; }
};

/// Checks by tracks that the caps are one mesh, and numbers the filling's vertices: those of the hull, then
/// the inner ones by inner level. Makes the filling's `points` for them; only the hull's are set. Throws as
/// fill_slab() does.
template<int D>
SlabColumns<D> slab_columns(const Hull<D>& hull, Filling<D>& filling);

} // namespace slabhull
