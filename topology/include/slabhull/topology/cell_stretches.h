// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Cells in stretches of consecutive numbers, each with the range of the vertices that it names, so that what
/// is done for some vertices after the others need not go through all cells each time: meshes are mostly
/// numbered so that what is near in space is near in memory. 1/500 byte per cell.
template<int D>
class CellStretches {
public:
    static constexpr std::size_t length = 1 << 12;

    explicit CellStretches(std::span<const Simplex<D>> cells) : cell_count_{cells.size()} {
        range_.resize((cells.size() + length - 1) / length);
        parallel_for(cells.size(), length, [&](std::size_t begin, std::size_t end) {
            Index lowest = cells[begin][0];
            Index highest = lowest;
            for (std::size_t c = begin; c < end; ++c) {
                for (const Index v : cells[c]) {
                    lowest = std::min(lowest, v);
                    highest = std::max(highest, v);
                }
            }
            range_[begin / length] = {lowest, highest};
        });
    }

    /// Those that may name vertices in [begin, end), by number.
    std::vector<Index> naming(std::size_t begin, std::size_t end) const {
        std::vector<Index> found;
        for (std::size_t s = 0; s < range_.size(); ++s) {
            if (range_[s][0] < end && range_[s][1] >= begin) {
                found.push_back(static_cast<Index>(s));
            }
        }
        return found;
    }

    /// Calls visit(cell) for the cells of a stretch.
    template<class Visit>
    void each_cell(Index stretch, const Visit& visit) const {
        const std::size_t begin = stretch * length;
        for (std::size_t c = begin; c < std::min(cell_count_, begin + length); ++c) {
            visit(c);
        }
    }

private:
    std::size_t cell_count_;
    std::vector<std::array<Index, 2>> range_; ///< lowest and highest vertex
};

/// How many vertices to look at at once, so that it takes about `passes` goes through a large mesh.
inline std::size_t vertices_at_once(std::size_t vertex_count, std::size_t passes) {
    constexpr std::size_t worth_a_pass = 1 << 16;
    constexpr std::size_t whole_buckets = 1 << 13;
    const std::size_t share = std::max(worth_a_pass, vertex_count / passes);
    return (share + whole_buckets - 1) / whole_buckets * whole_buckets;
}

} // namespace slabhull
