// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/cell_groups.h"

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Proves for the groups around a vertex v, together, that their cells have nothing in common but common
/// faces. All of it is in floating point with bounds of its errors, and linear in the cells.
///
/// Let M be the cells of all groups that have v. Facets of M are in one of its cells, and then on the border
/// of M, or in two that agree in orientation. Shown is, for a projection along a direction d onto D
/// dimensions:
///
/// 1. All cells of M keep their orientation, strictly: their normals are on one side of d.
/// 2. Every facet F of the border is seen from v on its inner side, strictly: the simplex of v and F has the
///    cells' orientation.
/// 3. There is a direction from v in which exactly one facet of the border lies.
///
/// Then the projection is injective on M, so M is embedded:
///
/// - Seen from v the border is a cycle on the sphere of directions, all its facets counted positively. Such a
///   cycle covers all generic directions equally often: once, by 3.
/// - The cells of M and the simplices of v and the border's facets are chains with one boundary, so they
///   cover generic points equally often; the latter at most once.
/// - Let points x and x' of M, in the interiors of faces s and s', be projected onto the same place. When no
///   facet of the border has s, the cells of M around s leave no facet open there; so they cover a whole
///   neighbourhood of the place, and a cell with x' that is not among them would cover a part of it twice. It
///   is among them, then; a cell is projected without loss, so x = x'. When both s and s' are in the border,
///   the same holds one dimension lower: the border's facets around s cover a whole neighbourhood of the
///   direction that x has from v, so one of them has x', and x = x'.
///
/// Nothing here asks that the cells around a vertex or edge hang together.
template<int D>
class GroupStars {
public:
    /// Needs: `neighbors` of all cells, right, each facet in two cells that agree. `scale`: see
    /// scale_of_cells().
    GroupStars(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
               std::span<const Neighbors<D>> neighbors, const CellGroups<D>& groups,
               const Point<D + 1>& scale);

    /// For each vertex of `vertices` whether its groups are proven embedded together.
    std::vector<char> prove(std::span<const Index> vertices) const;

private:
    Point<D + 1> scaled_normal(std::size_t cell) const;
    std::array<float, D + 1> group_normal(std::size_t group) const;

    std::span<const Point<D + 1>> points_;
    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    const CellGroups<D>& groups_;
    Point<D + 1> scale_;
    Array<std::array<float, D + 1>> normals_; ///< of the groups, of unit length, in scaled coordinates

    template<int>
    friend class StarProof;
};

/// Vertices such that any two tested groups that touch are both among the groups of one of these; so are any
/// two cells of one group.
template<int D>
std::vector<Index> star_centres(const CellGroups<D>& groups, std::size_t vertex_count);

extern template class GroupStars<2>;
extern template class GroupStars<3>;

} // namespace slabhull
