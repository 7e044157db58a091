// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/side_layer.h"
#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/core/vector.h"
#include "slabhull/slab/adapt.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Cells that are to become other cells with the same boundary.
template<int D>
struct Cavity {
    /// Stands in `added` for the vertex that an operation makes.
    static constexpr Index new_vertex = no_index - 1;

    OperationKind kind{};
    std::vector<Index> removed;
    std::vector<Simplex<D>> added; ///< positive at the layer's end
    Point<D> new_place{};          ///< of the new vertex
    double new_target = 0;         ///< the target length at it
    bool has_new_vertex = false;
    std::array<Index, 2> edge{}; ///< that is divided or collapsed; of a shift, its vertex
    Index ended = no_index;      ///< the vertex that ends
    Point<D> kernel{}; ///< a place at half time from which a cavity at rest sees all of its boundary
    Point<D + 1> apex{};
    /// What happens to the boundary, with vertices of the mesh; removes nothing inside.
    BoundaryChange<D> side;
    std::vector<Facet<D>> side_removed; ///< the facets that `side` removes, outward
    double quality_before = 0;          ///< the smallest of the cells removed ...
    double quality = 0;                 ///< ... and of those added

    bool on_boundary() const { return !side.removed.empty(); }
};

/// A mesh between two levels: the connectivity at the layer's start, places at its start and end. Vertices
/// are numbered by ascending column.
template<int D>
class AdaptMesh {
public:
    Array<Simplex<D>> cells; ///< positive at the start
    Array<Neighbors<D>> neighbors;
    Array<Point<D>> before;     ///< places of the vertices at the start of the layer
    Array<Point<D>> now;        ///< and at its end
    std::vector<double> target; ///< wanted length of edges at each vertex
    std::vector<Index> column;  ///< of each vertex
    std::vector<std::uint8_t> on_boundary;
    std::vector<Index> boundary; ///< the vertex that each of the boundary's vertices is

    /// Length over target of an edge at the layer's end.
    double length_ratio(Index a, Index b) const {
        return 2 * distance(now[a], now[b]) / (target[a] + target[b]);
    }

    /// Finds a cell at each vertex. To be called when the arrays are filled.
    void find_cells_of_vertices();

    /// The cells around a vertex.
    void gather_star(Index vertex, std::vector<Index>& star) const;
    /// The cells around an edge. Returns whether the edge is inside the domain.
    bool gather_edge_star(Index a, Index b, std::vector<Index>& star) const;

    /// Replaces the cells of cavities that share none; new vertices get columns from `next_column`. Appends
    /// to the log. Afterwards `before` is meaningless, and the vertices that ended are gone.
    void apply(std::span<const Cavity<D>> cavities, Index& next_column, AdaptLog<D>& log);

private:
    struct OpenFacet;
    void add_vertices(std::span<const Cavity<D>> cavities, Index& next_column,
                      std::vector<Simplex<D>>& added);
    void note(std::span<const Cavity<D>> cavities, const std::vector<Simplex<D>>& added,
              AdaptLog<D>& log) const;
    void replace(const std::vector<Index>& removed, const std::vector<Simplex<D>>& added);
    void pair(std::vector<OpenFacet>& open);
    void claim_vertices(Index cell);
    void drop_vertices(std::span<const Cavity<D>> cavities);

    std::vector<Index> cell_of_; ///< a cell at each vertex
};

/// Place of a vertex in a cell; D + 1 if it is none of its vertices.
template<int D>
std::size_t place_in(const Simplex<D>& cell, Index vertex) {
    std::size_t k = 0;
    while (k <= D && cell[k] != vertex) {
        ++k;
    }
    return k;
}

extern template class AdaptMesh<2>;
extern template class AdaptMesh<3>;

} // namespace slabhull
