// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/triangle_shape.h"

#include "slabhull/geometry/cap_mesher.h"

#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Insertion of points into a constrained Delaunay triangulation by the method of Bowyer and Watson. It has
/// two steps, so that the result can be judged before anything changes: `dig` finds the cavity of triangles
/// that a point would replace and the edges around it, `fill` joins the point to these.
///
///        +-----+              +-----+
///       / \   / \            / \   / \       .
///      /   \ /   \   dig    /   \ /   \      . rim: the six outer edges
///     +-----+-----+  ---->  +---- p ---+     .
///      \   / \   /   fill    \   / \   /     .
///       +-----+               +-----+
///
/// Edges without a neighbor are the constraints; a cavity never reaches beyond them. Decisions are exact.
class DelaunayCavity {
public:
    /// An edge of the rim, counter-clockwise, and the cell outside.
    struct Edge {
        Index from;
        Index to;
        Index beyond;     ///< the cell there, or no_index: a boundary edge
        std::size_t side; ///< local number of the cavity among its neighbors
        bool boundary() const { return beyond == no_index; }
    };

    /// `mesh` must outlive it, be positively oriented and constrained Delaunay.
    explicit DelaunayCavity(CapMesh<2>& mesh);

    /// Finds the cavity of p. False if p does not conflict with `start`, or cannot be joined to all of the
    /// rim by straight lines inside the domain. Needs: finite p.
    bool dig(Index start, const Point<2>& p);

    std::span<const Edge> rim() const { return rim_; }
    std::span<const Index> cells() const { return cells_; }

    /// Fills the last cavity dug with triangles (from, to, p), one for each edge of the rim, in that order;
    /// cells() then names these. They reuse the slots of the triangles replaced; the last two are new.
    void fill(const Point<2>& p);

private:
    bool conflicts(Index cell, const Point<2>& p) const;
    bool joins(Index cell, const Point<2>& p);
    bool sees_rim(const Point<2>& p) const;
    std::size_t side_of(Index cell, Index first) const;
    void add_cells();

    CapMesh<2>& mesh_;
    Array<std::uint64_t>
        seen_; ///< by cell: epoch_ if inside, epoch_ + 1 if outside, less if not yet visited for this cavity
    Array<Index> starting_; ///< by vertex: the new cell on the rim's edge that starts there
    std::uint64_t epoch_ = 0;
    std::vector<Index> cells_;
    std::vector<Edge> rim_;
};

} // namespace slabhull
