// SPDX-License-Identifier: BSD-3-Clause
// Cells that one rank sends to another, and their numbers there.
#pragma once

#include "core/ascending_numbers.h"
#include "core/pieces.h"
#include "slab/check/part_exchange.h"
#include "slabhull/core/array.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/index.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// A cell as one rank sends it to another.
template<int D>
struct GhostCell {
    std::uint64_t number;                       ///< in the hull
    std::array<std::uint64_t, D + 1> neighbors; ///< in the hull
    Simplex<D> vertices;                        ///< places in the list of points that is sent, too
};

/// Inserts the points of some of the part's cells, for sending these.
template<int D>
void insert_points_of(const HullPart<D>& part, std::span<const Index> cells, PointSet& points) {
    for (const Index c : cells) {
        for (const Index v : part.cells[c]) {
            points.insert(v);
        }
    }
}

/// The numbers in the hull of some of the part's points.
template<int D>
Array<std::uint64_t> numbers_of(const HullPart<D>& part, const PointSet& points) {
    Array<std::uint64_t> numbers;
    numbers.reserve(points.size());
    each_point_in(points.words(),
                  [&](std::size_t, std::size_t v) { numbers.push_back(part.points_used->member(v)); });
    return numbers;
}

template<int D>
GhostCell<D> ghost_cell(const HullPart<D>& part, Index c, const PointSet& sent) {
    GhostCell<D> cell{};
    cell.number = part.range.first + c;
    for (std::size_t i = 0; i <= D; ++i) {
        cell.neighbors[i] = part.in_hull(part.neighbors[c][i]);
        cell.vertices[i] = static_cast<Index>(sent.rank(part.cells[c][i]));
    }
    return cell;
}

template<int D>
Array<GhostCell<D>> ghost_cells(const HullPart<D>& part, std::span<const Index> cells, const PointSet& sent) {
    Array<GhostCell<D>> ghosts(cells.size());
    std::transform(cells.begin(), cells.end(), ghosts.begin(),
                   [&](Index c) { return ghost_cell<D>(part, c, sent); });
    return ghosts;
}

/// The numbers in the hull of ghosts, in order.
template<class Ghost>
Array<std::uint64_t> numbers_of_ghosts(const std::vector<Array<Ghost>>& lists) {
    Array<std::uint64_t> numbers;
    for (const Array<Ghost>& ghosts : lists) {
        for (const Ghost& ghost : ghosts) {
            numbers.push_back(ghost.number);
        }
    }
    return numbers;
}

/// Calls visit(owner) once for each of the owners that a cell's vertices have; `owners` are those of all
/// vertices.
template<int D, class Visit>
void each_owner(const Simplex<D>& cell, const Array<std::int32_t>& owners, const Visit& visit) {
    std::array<std::int32_t, D + 1> of_vertices;
    for (std::size_t i = 0; i <= D; ++i) {
        of_vertices[i] = owners[cell[i]];
        bool again = false;
        for (std::size_t j = 0; j < i; ++j) {
            again |= of_vertices[j] == of_vertices[i];
        }
        if (!again) {
            visit(of_vertices[i]);
        }
    }
}

/// Of each point, whether its owner is this rank.
inline Array<std::uint8_t> owned_by(const Array<std::int32_t>& owners, const Communicator& ranks) {
    Array<std::uint8_t> owned(owners.size());
    std::transform(owners.begin(), owners.end(), owned.begin(),
                   [&](std::int32_t owner) -> std::uint8_t { return owner == ranks.rank() ? 1 : 0; });
    return owned;
}

/// The numbers that points and cells of the hull have on a rank: first come the part's, then those of ghosts.
template<int D>
class GhostNumbering {
public:
    /// `points`: those of the ghosts, in any order. `leading` and `others`: the ghosts, in two lists of which
    /// each ascends.
    GhostNumbering(const HullPart<D>& part, Array<std::uint64_t> points, Array<std::uint64_t> leading,
                   Array<std::uint64_t> others)
        : part_{part}, points_{not_in(part, std::move(points))}, leading_{std::move(leading)},
          others_{std::move(others)} {}

    std::size_t point_count() const { return part_.points.size() + points_.size(); }
    std::size_t cell_count() const { return part_.cells.size() + leading_.size() + others_.size(); }

    /// What points are here. Needs: points that are.
    Array<Index> points(std::span<const std::uint64_t> numbers) const {
        Array<Index> here(numbers.size());
        std::transform(numbers.begin(), numbers.end(), here.begin(),
                       [this](std::uint64_t number) { return point(number); });
        return here;
    }

    /// no_index for a cell that is not here.
    Index cell(std::uint64_t number) const {
        if (part_.range.contains(number)) {
            return static_cast<Index>(number - part_.range.first);
        }
        if (const Index place = leading_.place(number); place != no_index) {
            return static_cast<Index>(part_.cells.size() + place);
        }
        const Index place = others_.place(number);
        return place == no_index ? no_index
                                 : static_cast<Index>(part_.cells.size() + leading_.size() + place);
    }

    /// The hull's number of a cell that is here.
    std::uint64_t in_hull(Index cell) const {
        if (cell < part_.cells.size()) {
            return part_.range.first + cell;
        }
        const std::size_t ghost = cell - part_.cells.size();
        return ghost < leading_.size() ? leading_[ghost] : others_[ghost - leading_.size()];
    }

    /// What the cells of HullPart::outside are here: ghosts, or no_index.
    Array<Index> outside() const {
        Array<Index> here(part_.outside.size());
        std::transform(part_.outside.begin(), part_.outside.end(), here.begin(),
                       [this](std::uint64_t number) { return cell(number); });
        return here;
    }

    /// Appends a ghost; `points`: what the points that came with it are here.
    void append(const GhostCell<D>& ghost, std::span<const Index> points, Array<Simplex<D>>& cells,
                Array<Neighbors<D>>& neighbors) const {
        Simplex<D>& vertices = cells.emplace_back();
        Neighbors<D>& across = neighbors.emplace_back();
        for (std::size_t i = 0; i <= D; ++i) {
            vertices[i] = points[ghost.vertices[i]];
            across[i] = cell(ghost.neighbors[i]);
        }
    }

private:
    Index point(std::uint64_t number) const {
        return static_cast<Index>(part_.points_used->contains(number)
                                      ? part_.points_used->rank(number)
                                      : part_.points.size() + points_.place(number));
    }

    static Array<std::uint64_t> not_in(const HullPart<D>& part, Array<std::uint64_t> points) {
        points.erase(std::remove_if(points.begin(), points.end(),
                                    [&](std::uint64_t each) { return part.points_used->contains(each); }),
                     points.end());
        sort_out(points);
        return points;
    }

    const HullPart<D>& part_;
    AscendingNumbers points_; ///< that only ghosts have
    AscendingNumbers leading_;
    AscendingNumbers others_;
};

} // namespace slabhull
