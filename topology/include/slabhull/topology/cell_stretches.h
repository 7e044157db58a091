// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Per stretch of 1,024 consecutive cells, a 256-bit mask of the vertex blocks that its cells use. A loop
/// over some of the vertices then visits only the stretches that may use them. That skips most cells, as
/// vertices that are near in space mostly have near numbers. Costs 1/32 byte per cell.
template<int D>
class CellStretches {
public:
    static constexpr std::size_t length = 1 << 10;

    /// `at_once`: how many vertices loops are over; where that is all, nothing is to be skipped, nor to be
    /// found for that. Needs: vertices of cells below `vertex_count`.
    CellStretches(std::span<const Simplex<D>> cells, std::size_t vertex_count, std::size_t at_once = 1)
        : cell_count_{cells.size()}, block_bits_{static_cast<int>(std::bit_width(vertex_count / blocks))} {
        if (at_once >= vertex_count) {
            return;
        }
        used_.resize((cells.size() + length - 1) / length);
        parallel_for(cells.size(), length, [&](std::size_t begin, std::size_t end) {
            Blocks& used = used_[begin / length];
            for (std::size_t c = begin; c < end; ++c) {
                for (const Index v : cells[c]) {
                    used[v >> block_bits_] = true;
                }
            }
        });
    }

    /// The stretches whose cells may use vertices in [begin, end), ascending.
    std::vector<Index> using_vertices(std::size_t begin, std::size_t end) const {
        Blocks wanted;
        for (std::size_t block = begin >> block_bits_; begin < end && block <= (end - 1) >> block_bits_;
             ++block) {
            wanted.set(block);
        }
        std::vector<Index> found;
        for (std::size_t s = 0; s * length < cell_count_; ++s) {
            if (used_.empty() || (used_[s] & wanted).any()) {
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
    static constexpr std::size_t blocks = 256;
    using Blocks = std::bitset<blocks>;

    std::size_t cell_count_;
    int block_bits_; ///< of a vertex's number, within its block
    std::vector<Blocks> used_;
};

/// How many vertices to look at at once, so that it takes about `passes` goes through a large mesh.
inline std::size_t vertices_at_once(std::size_t vertex_count, std::size_t passes) {
    constexpr std::size_t worth_a_pass = 1 << 16;
    constexpr std::size_t whole_buckets = 1 << 13;
    const std::size_t share = std::max(worth_a_pass, vertex_count / passes);
    return (share + whole_buckets - 1) / whole_buckets * whole_buckets;
}

} // namespace slabhull
