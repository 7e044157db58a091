// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// A facet that keeps a soup of simplices from being an oriented manifold.
template<int D>
struct FacetDefect {
    enum class Kind {
        open,        ///< in one cell only
        overfull,    ///< in three or more cells
        disoriented, ///< in two cells that induce the same orientation on it
    };
    Kind kind;
    Facet<D> facet;           ///< its vertices, ascending
    std::vector<Index> cells; ///< the cells that have it, ascending
};

/// Adjacency of D-simplices across their facets.
template<int D>
struct Adjacency {
    /// neighbors[c][i] is the cell across the facet of c opposite to its vertex i; no_index where that facet
    /// is open or overfull. Disoriented pairs are joined.
    Array<Neighbors<D>> neighbors;
    /// Every facet at fault, sorted by facet.
    std::vector<FacetDefect<D>> defects;
};

/// An adjacency that is stored elsewhere.
template<int D>
struct AdjacencyView {
    std::span<const Neighbors<D>> neighbors;
    std::span<const FacetDefect<D>> defects;

    AdjacencyView() = default;
    AdjacencyView(const Adjacency<D>& stored) : neighbors{stored.neighbors}, defects{stored.defects} {}
    /// Neighbours that are known to be right, so that there are no defects.
    explicit AdjacencyView(std::span<const Neighbors<D>> right) : neighbors{right} {}
};

/// Adjacency of a soup of simplices, from vertex numbers alone (D = 1 to 4).
/// Needs: vertices below `vertex_count`, no cell with a repeated vertex (such a cell's facets may pair
/// wrongly). Cost: near-linear. The result does not depend on the number of threads.
template<int D>
Adjacency<D> build_adjacency(std::span<const Simplex<D>> cells, std::size_t vertex_count);

} // namespace slabhull
