// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/block_mesh.h"

#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <cstring>

namespace slabhull {

MeshedBlock mesh_block(const DomainBlocks& blocks, std::size_t number, const SizeField<3>& size,
                       const CapOptions& options) {
    MeshedBlock block{surface_of_block(blocks.points, blocks.facets[number]), {}};
    block.mesh = fill_solid(Boundary<3>{block.surface.surface}, block.surface.surface, size, options);
    return block;
}

void number_in_cap(MeshedBlock& block, const BlockPlace& place, std::vector<OpenFacet>& open) {
    CapMesh<3>& mesh = block.mesh;
    const Array<Index>& given = block.surface.vertex;
    if (mesh.points.size() < given.size() ||
        std::memcmp(mesh.points.data(), block.surface.surface.points.data(),
                    given.size() * sizeof(Point<3>)) != 0) {
        throw GeometryError{"the mesher's result was refused: it moved or renumbered the points of a block"};
    }
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        Simplex<3>& cell = mesh.cells[c];
        for (Index& v : cell) {
            v = v < given.size() ? given[v] : place.first_point + (v - static_cast<Index>(given.size()));
        }
        for (std::size_t i = 0; i < 4; ++i) {
            Index& across = mesh.neighbors[c][i];
            if (across != no_index) {
                across += place.first_cell;
                continue;
            }
            Facet<3> facet = outward_facet<3>(cell, static_cast<int>(i));
            std::sort(facet.begin(), facet.end());
            open.push_back({facet, place.first_cell + static_cast<Index>(c), static_cast<Index>(i)});
        }
    }
}

void require_closed_blocks(std::size_t open, std::size_t boundary_facets) {
    if (open != boundary_facets) {
        throw GeometryError{
            fmt::format("the mesher's result was refused: blocks joined leave {} facets open, "
                        "and the boundary has {}",
                        open, boundary_facets)};
    }
}

} // namespace slabhull
