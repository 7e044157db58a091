// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/adjacency.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// What keeps a soup of simplices from being a closed oriented manifold. Each fault is blamed once, under the
/// first kind that explains it.
enum class ManifoldDefect {
    repeated_vertex,   ///< a cell names a vertex twice
    duplicate_cell,    ///< a cell has the same vertices as an earlier one
    unused_vertex,     ///< in no cell
    open_facet,        ///< in one cell only
    overfull_facet,    ///< in three or more cells
    disoriented_facet, ///< in two cells that induce the same orientation on it
    singular_edge,     ///< the cells around the edge are not one cycle (D = 3)
    singular_vertex,   ///< the link of the vertex is not one cycle (D = 2), one sphere (D = 3)
};
inline constexpr std::size_t manifold_defect_kinds = 8;

struct ManifoldFinding {
    ManifoldDefect what;
    std::vector<Index> vertices; ///< of the cell, facet or edge at fault
    std::vector<Index> cells;    ///< that take part, ascending; a duplicate comes before its original
    std::string detail;          ///< in words, without numbers of entities
};

struct ManifoldCounts {
    std::size_t vertices = 0; ///< used ones
    std::size_t edges = 0;
    std::size_t facets = 0;
    std::size_t cells = 0;
    std::size_t components = 0; ///< joined through facets
    std::int64_t euler = 0;     ///< Euler characteristic
};

/// The Euler characteristic of a D-manifold with so many vertices, edges, facets and cells.
template<int D>
std::int64_t euler_of(const ManifoldCounts& counts) {
    const auto alternating =
        static_cast<std::int64_t>(counts.vertices) - static_cast<std::int64_t>(counts.edges);
    const auto cells = static_cast<std::int64_t>(counts.cells);
    return D == 2 ? alternating + cells : alternating + static_cast<std::int64_t>(counts.facets) - cells;
}

struct ManifoldReport {
    ManifoldCounts counts;
    /// How many of each kind there are, whatever was kept.
    std::array<std::size_t, manifold_defect_kinds> found{};
    /// By kind, then by the numbers of the entities; at most `most_findings` of each kind.
    std::vector<ManifoldFinding> findings;

    std::size_t count(ManifoldDefect what) const { return found[static_cast<std::size_t>(what)]; }
    bool clean() const { return found == std::array<std::size_t, manifold_defect_kinds>{}; }
};

struct ManifoldOptions {
    std::size_t most_findings = 20; ///< kept of each kind
};

/// Examines whether D-simplices (D = 2, 3) form a closed oriented D-manifold, from vertex numbers alone.
/// Needs: vertices below `vertex_count`; `adjacency` as build_adjacency() gives it for these cells.
/// A vertex is sound when walking its star through facets meets every cell that uses it and, for D = 3, its
/// link has Euler characteristic 2: V - F / 2, as the link's edges are 3 F / 2. A connected closed surface of
/// characteristic 2 is a sphere without pinch points, so the edges at a sound vertex are sound too; only the
/// others are looked at closely. Vertices of facets and cells that are already at fault are not blamed again.
/// Cost: near-linear; about 1 extra byte per cell of a sound manifold. The result does not depend on the
/// number of threads.
template<int D>
ManifoldReport examine_manifold(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                const AdjacencyView<D>& adjacency, const ManifoldOptions& options = {});

/// The report of examine_manifold() when `claimed` are the cells' neighbours and the cells form a closed
/// oriented manifold; else nothing, and build_adjacency() and examine_manifold() tell what is wrong. Nothing
/// is trusted: each facet is compared with what is said to be across it, and at each vertex no facet is met
/// in two pairs of neighbours. Several times faster than finding the adjacency. Needs: vertices below
/// `vertex_count`. Cost: linear; about 1 extra byte per cell.
template<int D>
std::optional<ManifoldReport> confirm_manifold(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                               std::span<const Neighbors<D>> claimed);

/// How many components the cells form when joined through facets. About 4 extra bytes per cell.
template<int D>
std::size_t count_components(std::span<const Neighbors<D>> neighbors);

} // namespace slabhull
