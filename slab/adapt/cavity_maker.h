// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"
#include "slab/adapt/boundary_operations.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace slabhull {

/// Makes the cavities of operations on a mesh, as they would be at the layer's end. None where the operation
/// is impossible: on a boundary that is not adapted, or where a new cell would not be positive.
template<int D>
class CavityMaker {
public:
    /// An edge is removed only if no more cells than these surround it.
    static constexpr std::size_t most_around_edge = 7;

    /// `taken`, by cell: whether a cell may not be removed any more. `boundary`: none if it stays as it is.
    explicit CavityMaker(const AdaptMesh<D>& mesh, const std::vector<std::uint8_t>* taken = nullptr,
                         const BoundaryOperations<D>* boundary = nullptr)
        : mesh_{mesh}, taken_{taken}, boundary_{boundary} {}

    /// Operations whose new cells have a smaller quality than `factor` times that of the worst cell removed,
    /// or than `ceiling` if that is less, are not made.
    void demand(double factor, double ceiling) {
        factor_ = factor;
        ceiling_ = ceiling;
    }

    /// Divides an edge inside by a vertex near its midpoint.
    std::optional<Cavity<D>> split(Index a, Index b);
    /// Pulls vertex `ending`, inside, onto its neighbour `kept`.
    std::optional<Cavity<D>> collapse(Index ending, Index kept);
    // The same on the boundary.
    std::optional<Cavity<D>> split_boundary(Index a, Index b);
    std::optional<Cavity<D>> collapse_boundary(Index ending, Index kept);
    /// Moves a vertex of the boundary along it.
    std::optional<Cavity<D>> shift_boundary(Index vertex);
    /// Replaces a cell, and the one across its facet i, by those around the edge between their vertices
    /// opposite to the facet: two cells by two (D = 2), two by three (D = 3).
    std::optional<Cavity<D>> flip_facet(Index cell, std::size_t i);
    /// Replaces the cells around an edge by those that do not have it, the best of all triangulations of the
    /// polygon around it (dynamic programming; Klincsek 1980). On the boundary, the edge is flipped there. D
    /// = 3.
    std::optional<Cavity<D>> remove_edge(Index a, Index b);

private:
    double quality_of(const Simplex<D>& cell, const Cavity<D>& cavity) const;
    double least_quality(const Cavity<D>& cavity, double enough) const;
    void improve_new_place(Index a, Index b, Cavity<D>& cavity) const;
    /// Whether all cells to be removed are free; finds the quality of the worst.
    bool examine_removed(Cavity<D>& cavity) const;
    double demanded(const Cavity<D>& cavity) const;
    /// The cavity with its quality, if that is as demanded.
    std::optional<Cavity<D>> finished(Cavity<D>&& cavity) const;
    Point<D> half_way(Index v) const;
    bool order_ring(Index a, Index b, const std::vector<Index>& star, std::vector<Index>& ring) const;
    void divide(Index a, Index b, Cavity<D>& cavity) const;
    void pull(Index ending, Index kept, Cavity<D>& cavity) const;

    const AdaptMesh<D>& mesh_;
    const std::vector<std::uint8_t>* taken_;
    const BoundaryOperations<D>* boundary_;
    double factor_ = 0;
    double ceiling_ = 1;
};

extern template class CavityMaker<2>;
extern template class CavityMaker<3>;

} // namespace slabhull
