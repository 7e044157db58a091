// SPDX-License-Identifier: BSD-3-Clause
#include "adjacency_peers.h"

#include <petscdmplex.h>

#include <memory>
#include <stdexcept>

namespace slabhull::bench {

namespace {

void require(PetscErrorCode code) {
    if (code != 0) {
        throw std::runtime_error{"PETSc failed"};
    }
}

/// Facet k of a tetrahedron's cone in DMPlex is opposite to this vertex of the cell list's.
constexpr std::array<std::size_t, 4> opposite{3, 2, 1, 0};

void read_neighbors(DM mesh, Quad* result) {
    PetscInt first = 0;
    PetscInt end = 0;
    require(DMPlexGetHeightStratum(mesh, 0, &first, &end));
    for (PetscInt cell = first; cell < end; ++cell) {
        const PetscInt* facets = nullptr;
        require(DMPlexGetCone(mesh, cell, &facets));
        for (std::size_t k = 0; k < 4; ++k) {
            const PetscInt* sides = nullptr;
            PetscInt count = 0;
            require(DMPlexGetSupport(mesh, facets[k], &sides));
            require(DMPlexGetSupportSize(mesh, facets[k], &count));
            result[cell - first][opposite[k]] =
                count == 2 ? static_cast<std::uint32_t>(sides[sides[0] == cell ? 1 : 0] - first) : no_cell;
        }
    }
}

/// The usual way: a DMPlex from the list of cells, then facets (and edges) by interpolation; a facet's
/// support is its two cells. DMPlexCreateNeighborCSR is no shorter: it names the neighbours, not their
/// facets.
Peer::Find dmplex(const TetSoup& soup) {
    PetscBool ready = PETSC_FALSE;
    require(PetscInitialized(&ready));
    if (!ready) {
        require(PetscInitializeNoArguments());
    }
    const auto cells =
        std::make_shared<std::vector<PetscInt>>(soup.cells->data(), soup.cells->data() + 4 * soup.cell_count);
    return [soup, cells](Quad* result) {
        DM plain = nullptr;
        DM mesh = nullptr;
        require(DMCreate(PETSC_COMM_SELF, &plain));
        require(DMSetType(plain, DMPLEX));
        require(DMSetDimension(plain, 3));
        require(DMPlexBuildFromCellList(plain, static_cast<PetscInt>(soup.cell_count),
                                        static_cast<PetscInt>(soup.point_count), 4, cells->data()));
        require(DMPlexInterpolate(plain, &mesh));
        require(DMDestroy(&plain));
        read_neighbors(mesh, result);
        require(DMDestroy(&mesh));
    };
}

const bool added = add_peer({"petsc_dmplex", 9, dmplex});

} // namespace

} // namespace slabhull::bench
