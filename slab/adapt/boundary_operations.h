// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"
#include "slab/adapt/patch_surfaces.h"
#include "slabhull/topology/boundary.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace slabhull {

/// What operations do to the boundary of the mesh: they replace facets within a patch by facets around the
/// same ridges. Vertices are those of the mesh; patch borders and sharp edges are kept.
template<int D>
class BoundaryOperations {
public:
    /// `spacing`: wanted length of edges at each vertex of the boundary. All must outlive this.
    BoundaryOperations(const AdaptMesh<D>& mesh, const Boundary<D>& boundary, std::span<const double> spacing,
                       const PatchSurfaces<D>& surfaces, const std::array<double, 2>& times,
                       const AdaptOptions& options);

    /// Length of an edge of the boundary over what is wanted, at the layer's end.
    double length_ratio(Index a, Index b) const;
    /// The same for edges that the cavity's operation makes.
    double length_ratio(Index a, Index b, const Cavity<D>& cavity) const;
    /// Whether the angles opposite to an edge add up to notably more than 180 degrees. D = 3.
    bool wants_flip(Index a, Index b) const;

    // Each makes the cavity's `side`, and the new vertex's place; false where the operation is impossible.

    /// Divides edge ab at its midpoint, projected where the patch is.
    bool split(Index a, Index b, Cavity<D>& cavity) const;
    /// Pulls vertex `ending` onto its neighbour `kept`.
    bool collapse(Index ending, Index kept, Cavity<D>& cavity) const;
    /// Ends a vertex and begins one in the middle of its neighbours, where the edges there are nearer to what
    /// is wanted.
    bool shift(Index vertex, Cavity<D>& cavity) const;
    /// Replaces edge ab by the one between the vertices opposite to it. D = 3.
    bool flip(Index a, Index b, Cavity<D>& cavity) const;

private:
    double worst_ratio(const std::vector<Index>& around, const Point<D>& place, double spacing) const;
    std::optional<Point<D>> middle_of(const std::vector<Index>& around, const std::vector<Index>& star,
                                      PatchNumber patch) const;
    Index own(Index mesh_vertex) const { return number_[mesh_vertex]; }
    const Point<D>& now(Index own) const { return mesh_.now[mesh_.boundary[own]]; }
    Point<D> at_half_time(Index own) const;
    Point<D + 1> apex(PatchNumber patch, const Point<D>& place) const;

    void gather_star(Index own, std::vector<Index>& star) const;
    std::vector<Index> facets_at_edge(Index a, Index b) const;
    std::vector<Index> neighbors_of(const std::vector<Index>& star, Index own) const;
    /// The patch of all these facets, if there are any and it is one whose facets may be changed.
    std::optional<PatchNumber> patch_of(const std::vector<Index>& facets) const;

    bool keeps_sharp_edges(const std::vector<Index>& star, Index ending, Index kept) const;
    double cosine(const Facet<D>& a, const Facet<D>& b) const;
    bool stays_near(const Point<D>& place, const std::vector<Facet<D>>& facets, PatchNumber patch,
                    double spacing) const;
    void set_side(const std::vector<Index>& removed, const std::vector<Facet<D>>& added, PatchNumber patch,
                  const Point<D + 1>& apex, Cavity<D>& cavity) const;

    const AdaptMesh<D>& mesh_;
    const Boundary<D>& boundary_;
    std::span<const double> spacing_;
    const PatchSurfaces<D>& surfaces_;
    std::array<double, 2> times_;
    const AdaptOptions& options_;
    double sharp_;                ///< cosine of the feature angle
    double half_sharp_;           ///< ... of half of it
    std::vector<Index> number_;   ///< of each vertex of the mesh, the boundary's own; no_index inside
    std::vector<Index> facet_of_; ///< a facet at each vertex of the boundary
};

extern template class BoundaryOperations<2>;
extern template class BoundaryOperations<3>;

} // namespace slabhull
