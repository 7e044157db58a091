// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/joined_spans.h"
#include "geometry/embedding/cell_groups.h"

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Proves for all groups around a vertex v at once that their cells meet in common faces only. In floating
/// point with error bounds, and linear in the cells.
///
/// Let M be the cells of all groups at v. A facet of M is in one of its cells, and then in the border of M,
/// or in two that agree in orientation. The proof shows, for a projection along a direction d onto D
/// dimensions:
///
/// 1. All cells of M keep their orientation, strictly: their normals are on one side of d.
/// 2. Every facet F of the border has v on its inner side, strictly: the simplex of v and F has the cells'
///    orientation.
/// 3. There is a direction from v in which exactly one facet of the border lies.
///
/// Then the projection is injective on M, so M is embedded:
///
/// - Seen from v, the border is a cycle on the sphere of directions, all its facets counted positively.
///   Such a cycle covers all generic directions equally often: once, by 3.
/// - The cells of M, and the simplices of v and the border's facets, are chains with the same boundary, so
///   they cover generic points equally often; the latter at most once.
/// - Let x and x' be points of M, in the interiors of faces s and s', with the same projection. If s is in no
///   facet of the border, the cells of M around s cover a whole neighbourhood of that projection. A cell with
///   x' that is not among them would cover a part of it twice. So it is among them; a cell is projected
///   injectively, so x = x'. If both s and s' are in the border, the same holds one dimension lower: the
///   border's facets around s cover a whole neighbourhood of the direction from v to x, so one of them has
///   x', and x = x'.
///
/// The proof does not assume that the cells around a vertex or edge are connected.
template<int D>
class GroupStars {
public:
    /// Needs: neighbours of all cells, correct, each facet in two cells that agree. `scale`: see
    /// scale_of_cells().
    GroupStars(const JoinedSpans<Point<D + 1>>& points, const PartialMesh<D>& mesh,
               const CellGroups<D>& groups, const Point<D + 1>& scale);

    /// For each vertex of `vertices`: whether its groups together are proven embedded.
    std::vector<char> prove(std::span<const Index> vertices) const;

private:
    /// A cell by its vertices' local numbers in the list of its group.
    struct LocalCell {
        std::array<std::uint8_t, D + 1> corner;
        std::uint8_t outer; ///< bit i: facet i is not shared by two cells of the group
    };

    void list_cells(std::size_t group);
    std::span<const LocalCell> cells_of(std::size_t group) const {
        return {local_.data() + groups_.cells_before(group), groups_.cell_count(group)};
    }
    Point<D + 1> scaled_normal(std::size_t cell) const;
    std::array<float, D + 1> group_normal(std::size_t group) const;

    JoinedSpans<Point<D + 1>> points_;
    PartialMesh<D> mesh_;
    const CellGroups<D>& groups_;
    Point<D + 1> scale_;
    Array<LocalCell> local_;
    Array<std::array<float, D + 1>> normals_; ///< of the groups, of unit length, in scaled coordinates

    template<int>
    friend class StarProof;
};

/// Vertices such that any two tested groups that touch are both at one of these vertices; so are any two
/// cells of one group. Of prisms in layers, those of inner levels: around a vertex at the end of the side
/// are no prisms but those that are also around the one on the next level.
template<int D>
std::vector<Index> star_centres(const CellGroups<D>& groups, std::size_t vertex_count);

extern template class GroupStars<2>;
extern template class GroupStars<3>;

} // namespace slabhull
