// SPDX-License-Identifier: BSD-3-Clause
// Cells that one rank sends to another, and their numbers there.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace slabhull {

/// A cell in the numbers of the hull.
template<int D>
struct CellInHull {
    std::uint64_t number;
    std::array<std::uint64_t, D + 1> vertices;
    std::array<std::uint64_t, D + 1> neighbors;
};

template<int D>
CellInHull<D> cell_in_hull(const HullPart<D>& part, std::size_t c) {
    CellInHull<D> cell{};
    cell.number = part.range.first + c;
    for (std::size_t i = 0; i <= D; ++i) {
        cell.vertices[i] = part.points_used->member(part.cells[c][i]);
        cell.neighbors[i] = part.in_hull(part.neighbors[c][i]);
    }
    return cell;
}

/// Calls visit(owner) once for each of the owners that a cell's vertices have; `owners` are those of all
/// vertices.
template<int D, class Visit>
void each_owner(const Simplex<D>& cell, const Array<std::int32_t>& owners, const Visit& visit) {
    std::array<std::int32_t, D + 1> of_vertices;
    for (std::size_t i = 0; i <= D; ++i) {
        of_vertices[i] = owners[cell[i]];
        const auto here = of_vertices.begin() + i;
        if (std::find(of_vertices.begin(), here, *here) == here) {
            visit(*here);
        }
    }
}

/// The numbers that points and cells of the hull have on a rank: first come the part's, then those of ghosts.
template<int D>
class LocalNumbering {
public:
    /// `points`: those that only ghosts have, ascending. `cells`: the ghosts; the first `leading` of
    /// them ascend, and so do the others.
    LocalNumbering(const HullPart<D>& part, Array<std::uint64_t> points, Array<std::uint64_t> cells,
                   std::size_t leading)
        : part_{part}, points_{std::move(points)}, cells_{std::move(cells)}, leading_{leading} {}

    std::size_t point_count() const { return part_.points.size() + points_.size(); }

    /// Needs: a point that is here.
    Index point(std::uint64_t number) const {
        if (part_.points_used->contains(number)) {
            return static_cast<Index>(part_.points_used->rank(number));
        }
        const auto place = std::lower_bound(points_.begin(), points_.end(), number) - points_.begin();
        return static_cast<Index>(part_.points.size() + static_cast<std::size_t>(place));
    }

    /// no_index for a cell that is not here.
    Index cell(std::uint64_t number) const {
        if (part_.range.contains(number)) {
            return static_cast<Index>(number - part_.range.first);
        }
        const std::span<const std::uint64_t> all{cells_};
        for (const auto& list : {all.first(leading_), all.subspan(leading_)}) {
            const auto place = std::lower_bound(list.begin(), list.end(), number);
            if (place != list.end() && *place == number) {
                return static_cast<Index>(part_.cells.size() +
                                          static_cast<std::size_t>(&*place - all.data()));
            }
        }
        return no_index;
    }

    /// The hull's number of a cell that is here.
    std::uint64_t in_hull(Index cell) const {
        return cell < part_.cells.size() ? part_.range.first + cell : cells_[cell - part_.cells.size()];
    }

    /// What the cells of HullPart::outside are here: ghosts, or no_index.
    Array<Index> outside() const {
        Array<Index> here(part_.outside.size());
        std::transform(part_.outside.begin(), part_.outside.end(), here.begin(),
                       [this](std::uint64_t number) { return cell(number); });
        return here;
    }

    void append(const CellInHull<D>& ghost, Array<Simplex<D>>& cells, Array<Neighbors<D>>& neighbors) const {
        Simplex<D>& vertices = cells.emplace_back();
        Neighbors<D>& across = neighbors.emplace_back();
        for (std::size_t i = 0; i <= D; ++i) {
            vertices[i] = point(ghost.vertices[i]);
            across[i] = cell(ghost.neighbors[i]);
        }
    }

private:
    const HullPart<D>& part_;
    Array<std::uint64_t> points_;
    Array<std::uint64_t> cells_;
    std::size_t leading_;
};

} // namespace slabhull
