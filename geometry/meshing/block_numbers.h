// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/block_mesh.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

class Communicator;

/// Which numbers the cells and new points of blocks have in a cap, and on which rank they are: block b on
/// rank b modulo the number of ranks, where its cells stand in rows after those of the rank's earlier blocks.
class BlockNumbers {
public:
    /// `own` are this rank's blocks, of `blocks`, which share the cap's first `shared_points`. Throws
    /// LimitError for a cap that 32 bits do not number. Collective.
    BlockNumbers(std::span<const MeshedBlock> own, std::size_t blocks, std::size_t shared_points,
                 Communicator& ranks);

    BlockPlace place(std::size_t block) const { return {first_cell_[block], first_point_[block]}; }
    std::size_t blocks() const { return first_row_.size(); }
    std::size_t cells_of(std::size_t block) const { return first_cell_[block + 1] - first_cell_[block]; }
    std::size_t new_points_of(std::size_t block) const {
        return first_point_[block + 1] - first_point_[block];
    }
    std::size_t points() const { return first_point_.back(); }

    std::size_t rank_of(Index cell) const { return block_of(cell) % ranks_; }
    /// On its rank.
    Index row_of(Index cell) const {
        const std::size_t block = block_of(cell);
        return first_row_[block] + (cell - first_cell_[block]);
    }
    /// The numbers of this rank's rows.
    Array<Index> numbers_of_rows() const;

private:
    std::size_t block_of(Index cell) const;

    std::size_t rank_;
    std::size_t ranks_;
    std::vector<Index> first_cell_;  ///< by block, and the end
    std::vector<Index> first_point_; ///< the same
    std::vector<Index> first_row_;   ///< by block
};

} // namespace slabhull
