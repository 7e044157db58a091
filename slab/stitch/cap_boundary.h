// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/cap_cells.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// Facet `place` of a cell.
struct CellFacet {
    Index cell = no_index;
    std::uint8_t place = 0;
};

/// The cell, and the facet of that cell, of each boundary facet of a mesh.
/// Throws GeometryError when the boundary facets are not exactly the cells' facets without a neighbour,
/// orientation included. Cost: linear.
template<int D>
Array<CellFacet> find_boundary_facets(const SpatialMesh<D>& mesh);

/// The same of a mesh whose cells are on ranks; `mesh` itself has none. All ranks get all. Collective; throws
/// on all ranks, or on none.
template<int D>
Array<CellFacet> find_boundary_facets(const SpatialMesh<D>& mesh, const CapCells<D>& cells,
                                      Communicator& ranks);

} // namespace slabhull
