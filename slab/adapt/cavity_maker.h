// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"

#include <optional>
#include <vector>

namespace slabhull {

/// Makes the cavities of operations on a mesh, as they would be at the layer's end. None where the operation
/// is impossible: on the domain's boundary, or where a new cell would not be positive.
template<int D>
class CavityMaker {
public:
    /// An edge is removed only if no more cells than these surround it.
    static constexpr std::size_t most_around_edge = 7;

    explicit CavityMaker(const AdaptMesh<D>& mesh) : mesh_{mesh} {}

    /// Divides an edge by a vertex at its midpoint.
    std::optional<Cavity<D>> split(Index a, Index b);
    /// Pulls vertex `ending` onto its neighbour `kept`.
    std::optional<Cavity<D>> collapse(Index ending, Index kept);
    /// Replaces a cell, and the one across its facet i, by those around the edge between their vertices
    /// opposite to the facet: two cells by two (D = 2), two by three (D = 3).
    std::optional<Cavity<D>> flip_facet(Index cell, std::size_t i);
    /// Replaces the cells around an edge by those that do not have it, the best of all triangulations of the
    /// polygon around it (dynamic programming; Klincsek 1980). D = 3.
    std::optional<Cavity<D>> remove_edge(Index a, Index b);

private:
    double quality_of(const Simplex<D>& cell, const Cavity<D>& cavity) const;
    double least_quality(const Cavity<D>& cavity, double enough) const;
    void improve_new_place(Index a, Index b, Cavity<D>& cavity) const;
    std::optional<Cavity<D>> finished(Cavity<D>&& cavity) const;
    Point<D> half_way(Index v) const;
    bool order_ring(Index a, Index b, const std::vector<Index>& star, std::vector<Index>& ring) const;

    const AdaptMesh<D>& mesh_;
    std::vector<Index> star_;
};

extern template class CavityMaker<2>;
extern template class CavityMaker<3>;

} // namespace slabhull
