// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <vector>

namespace slabhull {

/// The boundary of a spatial domain: a closed (D-1)-manifold of facets. Outward orientation: for the edges
/// e_i of a facet and its outward normal n, det[e_1 .. e_(D-1), n] > 0. So for D = 3 the right-hand rule
/// gives n, and for D = 2 the domain lies to the right of each edge.
template<int D>
struct Surface {
    Array<Point<D>> points;
    Array<Facet<D>> facets;
    std::vector<PatchNumber> patch; ///< of each facet
    PatchList patches;
};

/// A mesh of the domain at one instant: what a cap is made of. Cells are positively oriented.
template<int D>
struct SpatialMesh {
    Array<Point<D>> points;
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors; ///< no_index across boundary facets

    Array<Facet<D>> boundary_facets; ///< outward, vertices of this mesh
    std::vector<PatchNumber> boundary_patch;
    PatchList patches;

    Array<PersistentId> vertex_ids;
    Array<TrackId> track_ids; ///< no_track for interior vertices
};

/// Sign of the outward orientation of facet i of a positively oriented D-simplex, whose vertices are taken in
/// ascending order leaving out vertex i: +1 when that order is the outward one.
template<int D>
constexpr int outward_sign(int i) {
    return (D - i) % 2 == 0 ? -1 : 1;
}

/// Facet i of a cell, in the outward orientation when the cell is positive.
template<int D>
constexpr Facet<D> outward_facet(const Simplex<D>& cell, int i) {
    Facet<D> facet{};
    int place = 0;
    for (int k = 0; k <= D; ++k) {
        if (k != i) {
            facet[static_cast<std::size_t>(place++)] = cell[static_cast<std::size_t>(k)];
        }
    }
    if (outward_sign<D>(i) < 0) {
        const Index first = facet[0];
        facet[0] = facet[1];
        facet[1] = first;
    }
    return facet;
}

/// The facet of a cell that has these vertices, in any order, in the outward orientation when the cell is
/// positive.
template<int D>
constexpr Facet<D> outward_facet(const Simplex<D>& cell, const Facet<D>& vertices) {
    int opposite = 0;
    while (opposite < D && std::find(vertices.begin(), vertices.end(),
                                     cell[static_cast<std::size_t>(opposite)]) != vertices.end()) {
        ++opposite;
    }
    return outward_facet<D>(cell, opposite);
}

} // namespace slabhull
