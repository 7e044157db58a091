// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/triangle_shape.h"

#include "slabhull/geometry/cap_mesher.h"

#include <span>
#include <vector>

namespace slabhull {

/// The star of an interior vertex of a constrained Delaunay triangulation, for moving the vertex.
class VertexStar {
public:
    /// `mesh` must outlive it.
    explicit VertexStar(CapMesh<2>& mesh) : mesh_{mesh} {}

    /// Collects the star of a vertex of `cell`. False if the vertex is on the boundary.
    bool gather(Index cell, Index vertex);

    std::span<const Index> cells() const { return cells_; }
    /// Mean of the link's vertices.
    Point<2> centroid() const;
    /// Least sine of an angle in the star if the vertex were at p; 0 if a triangle would be inverted.
    double least_sine(const Point<2>& p) const;
    /// Distance from p to the nearest vertex of the link.
    double clearance(const Point<2>& p) const;

    /// Moves the vertex to p and flips edges until the triangulation is constrained Delaunay again, which can
    /// only increase the least angle. Needs: least_sine(p) > 0. cells() then names all triangles changed.
    void move(const Point<2>& p);

private:
    plane::Corners corners(Index cell) const;
    /// The star's triangle i, with the vertex moved to p as its first corner.
    plane::Corners moved(std::size_t i, const Point<2>& p) const;
    bool flip_one_edge_of(Index cell);
    void flip(Index cell, std::size_t k);
    void tell(Index cell, Index before, Index now);

    CapMesh<2>& mesh_;
    Index vertex_ = no_index;
    std::vector<Index> cells_;
    std::vector<std::array<Index, 2>> link_; ///< of each cell: the edge opposite to the vertex
    std::vector<Index> changed_;
};

} // namespace slabhull
