// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/domain_blocks.h"

#include "slabhull/geometry/cap_mesher.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slabhull {

/// A block's surface, and the mesh of the block.
struct MeshedBlock {
    BlockSurface surface;
    CapMesh<3> mesh;
};

MeshedBlock mesh_block(const DomainBlocks& blocks, std::size_t number, const SizeField<3>& size,
                       const CapOptions& options);

/// A facet of a cell without a neighbour in its own block.
struct OpenFacet {
    Facet<3> vertices; ///< ascending
    Index cell;
    Index place;
    friend auto operator<=>(const OpenFacet&, const OpenFacet&) = default;
};

/// The numbers that a block's first cell and its first new point have in the cap.
struct BlockPlace {
    Index first_cell;
    Index first_point;
};

/// Gives vertices and neighbours of a block's cells their numbers in the cap, and appends the open facets.
/// Throws GeometryError when the mesher has moved or renumbered points.
void number_in_cap(MeshedBlock& block, const BlockPlace& place, std::vector<OpenFacet>& open);

/// Sorts open facets and passes each two that are the same to join(one, other). Returns how many are left.
template<class List, class Join>
std::size_t join_open_facets(List& open, const Join& join) {
    std::sort(open.begin(), open.end());
    std::size_t left = open.size();
    for (std::size_t k = 0; k + 1 < open.size(); ++k) {
        if (open[k].vertices == open[k + 1].vertices) {
            join(open[k], open[k + 1]);
            left -= 2;
            ++k;
        }
    }
    return left;
}

/// Throws GeometryError unless as many facets are left open as the boundary has.
void require_closed_blocks(std::size_t open, std::size_t boundary_facets);

} // namespace slabhull
