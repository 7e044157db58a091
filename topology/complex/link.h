// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// How the link of a vertex fails to be one cycle (D = 2) or one sphere (D = 3).
struct LinkFaults {
    /// Link vertices in which several cycles of cells meet: the edge to each of them is singular (D = 3).
    /// Ascending.
    std::vector<Index> pinches;
    /// Connected components of the link; those that touch in a pinch count as one.
    std::size_t pieces = 0;
    /// Euler characteristic of the first piece that is not a sphere when cut apart at its pinches (D = 3),
    /// else 2.
    long euler = 2;
    std::size_t link_vertices = 0;

    bool singular_vertex() const { return pieces > 1 || euler != 2; }
};

/// Takes the link of a vertex apart, given all cells that use it. Meant for the few vertices where something
/// is wrong. Needs: the facets at the vertex all in exactly two cells, else only `pieces` and `link_vertices`
/// mean something.
template<int D>
LinkFaults examine_link(Index vertex, std::span<const Index> star, std::span<const Simplex<D>> cells,
                        std::span<const Neighbors<D>> neighbors);

} // namespace slabhull
