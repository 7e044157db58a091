// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/block_numbers.h"

#include "slabhull/core/communicator.h"

#include <algorithm>

namespace slabhull {

namespace {

struct BlockCounts {
    std::uint64_t cells;
    std::uint64_t new_points;
};

} // namespace

BlockNumbers::BlockNumbers(std::span<const MeshedBlock> own, std::size_t blocks, std::size_t shared_points,
                           Communicator& ranks)
    : rank_{static_cast<std::size_t>(ranks.rank())}, ranks_{static_cast<std::size_t>(ranks.size())} {
    std::vector<BlockCounts> counts;
    for (const MeshedBlock& block : own) {
        counts.push_back({block.mesh.cells.size(), block.mesh.points.size() - block.surface.vertex.size()});
    }
    const std::vector<Array<BlockCounts>> all = ranks.all_gather<BlockCounts>(counts);
    std::vector<Index> rows(ranks_, 0);
    std::uint64_t cell = 0;
    std::uint64_t point = shared_points;
    for (std::size_t block = 0; block < blocks; ++block) {
        const auto [cells, new_points] = all[block % ranks_][block / ranks_];
        first_cell_.push_back(checked_index(cell, "cells of a cap"));
        first_point_.push_back(checked_index(point, "points of a cap"));
        first_row_.push_back(rows[block % ranks_]);
        rows[block % ranks_] += static_cast<Index>(cells);
        cell += cells;
        point += new_points;
    }
    first_cell_.push_back(checked_index(cell, "cells of a cap"));
    first_point_.push_back(checked_index(point, "points of a cap"));
}

std::size_t BlockNumbers::block_of(Index cell) const {
    const auto after = std::upper_bound(first_cell_.begin(), first_cell_.end(), cell);
    return static_cast<std::size_t>(after - first_cell_.begin()) - 1;
}

Array<Index> BlockNumbers::numbers_of_rows() const {
    Array<Index> numbers;
    for (std::size_t block = rank_; block < blocks(); block += ranks_) {
        for (std::size_t k = 0; k < cells_of(block); ++k) {
            numbers.push_back(first_cell_[block] + static_cast<Index>(k));
        }
    }
    return numbers;
}

} // namespace slabhull
