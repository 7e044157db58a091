// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/spatial_mesh.h"

#include <cstddef>

namespace slabhull {

/// The cells of a cap that one of several ranks has: a range, in the numbers of the whole cap. Ranges ascend
/// with ranks. The points of the cap are on every rank.
template<int D>
struct CapCells {
    std::size_t all = 0; ///< of the whole cap
    HullRange range;     ///< which of them are here
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors;
};

/// Leaves the cells of a cap that every rank has whole on the first rank alone.
template<int D>
void leave_cells_on_first(SpatialMesh<D>& cap, const Communicator& ranks);

/// Takes the cells out of a cap, of which each rank has some: those of a lower rank come before. Collective.
template<int D>
CapCells<D> take_cells(SpatialMesh<D>& cap, Communicator& ranks);

/// The same cells in other ranges: `wanted` is what this rank shall have. Collective.
template<int D>
CapCells<D> redistributed(CapCells<D>&& cells, const HullRange& wanted, Communicator& ranks);

/// The terminating cap's cells in a part of a hull.
template<int D>
CapCells<D> terminating_cells_of(const HullPart<D>& part, const HullOrder<D>& order);

/// The vertices of all cells on the first rank; elsewhere none. Collective.
template<int D>
Array<Simplex<D>> all_cells_on_first(const CapCells<D>& cells, Communicator& ranks);

} // namespace slabhull
