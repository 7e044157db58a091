// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/manifold.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace slabhull {

/// Some cells of a mesh: all that have one of the wanted vertices, and perhaps others. They are in two lists,
/// own cells and ghosts, so that ghosts need no copy of the own ones; ghosts have the numbers after them.
template<int D>
struct PartialMesh {
    std::span<const Simplex<D>> own;
    /// A cell of `own`, or own.size() + k for outside[k].
    std::span<const Neighbors<D>> own_neighbors;
    std::span<const Index> outside; ///< cells here that neighbours stand for; no_index for those not here
    std::span<const Simplex<D>> ghosts;
    std::span<const Neighbors<D>> ghost_neighbors; ///< cells here, or no_index
    std::span<const std::uint8_t> wanted;          ///< of each vertex, whether its star is to be examined

    std::size_t size() const { return own.size() + ghosts.size(); }
    std::size_t vertex_count() const { return wanted.size(); }
    bool is_wanted(Index vertex) const { return wanted[vertex] != 0; }
    const Simplex<D>& cell(Index c) const { return c < own.size() ? own[c] : ghosts[c - own.size()]; }
    Index neighbor(Index c, std::size_t i) const {
        if (c >= own.size()) {
            return ghost_neighbors[c - own.size()][i];
        }
        const Index across = own_neighbors[c][i];
        return across < own.size() ? across : outside[across - own.size()];
    }
    /// Prefetches a cell that is looked at soon.
    void prefetch(Index c) const {
        if (c < own.size()) {
            __builtin_prefetch(&own[c]);
            __builtin_prefetch(&own_neighbors[c]);
        }
    }
};

struct StarCounts {
    std::size_t vertices = 0;      ///< wanted ones
    std::size_t link_vertices = 0; ///< over their links
};

/// The counts of a closed D-manifold with so many cells, but for its components. `stars`: of all its
/// vertices.
template<int D>
ManifoldCounts closed_counts(std::size_t cells, const StarCounts& stars) {
    ManifoldCounts counts;
    counts.vertices = stars.vertices;
    counts.cells = cells;
    counts.facets = cells * (D + 1) / 2;
    counts.edges = D == 2 ? counts.facets : stars.link_vertices / 2;
    counts.euler = euler_of<D>(counts);
    return counts;
}

/// Whether the star of every wanted vertex is that of a closed oriented manifold: what confirm_manifold()
/// proves of a whole mesh, vertex by vertex, so that parts whose wanted vertices are together all vertices
/// prove it of the mesh. Nothing is trusted: each facet with a wanted vertex is compared with what is said to
/// be across it. Empty where it is not so, for whatever reason. Needs: numbers in range. Cost: linear; 4
/// bytes per vertex.
template<int D>
std::optional<StarCounts> confirm_stars(const PartialMesh<D>& mesh);

} // namespace slabhull
