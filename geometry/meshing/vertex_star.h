// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/triangle_shape.h"

#include "slabhull/geometry/cap_mesher.h"

#include <span>
#include <vector>

namespace slabhull {

/// The triangles around an interior vertex of a constrained Delaunay triangulation, for moving the vertex.
class VertexStar {
public:
    /// `mesh` must outlive it.
    explicit VertexStar(CapMesh<2>& mesh) : mesh_{mesh} {}

    /// Walks around a vertex of `cell`. False when that is on the boundary.
    bool gather(Index cell, Index vertex);

    std::span<const Index> cells() const { return cells_; }
    /// Mean of the vertices around.
    Point<2> centroid() const;
    /// Least sine of an angle in the star, were the vertex at p; 0 when a triangle would be inverted.
    double least_sine(const Point<2>& p) const;
    /// Distance from p to the nearest vertex around.
    double clearance(const Point<2>& p) const;

    /// Moves the vertex to p, where least_sine(p) > 0, and flips edges until the triangulation is constrained
    /// Delaunay again; that only makes the least angle larger. cells() then names all triangles changed.
    void move(const Point<2>& p);

private:
    plane::Corners corners(Index cell) const;
    /// The star's triangle with the vertex at p in its first corner.
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
