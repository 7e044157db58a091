// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Where cells go when some are removed and others added. The added cells take the numbers of those removed,
/// ascending, then further ones. Numbers left over go to the last cells, so that none is unused.
struct CellReplacement {
    struct Move {
        Index before;
        Index now;
    };
    std::vector<Index> added; ///< number of each added cell
    std::vector<Move> moves;  ///< of cells that are kept, to be made in this order: from the last
    std::size_t count = 0;    ///< of cells afterwards

    /// `removed` are different numbers below `cells`, in any order.
    CellReplacement(std::size_t cells, std::vector<Index> removed, std::size_t added_cells) {
        std::sort(removed.begin(), removed.end());
        count = cells - removed.size() + added_cells;
        const std::size_t reused = std::min(removed.size(), added_cells);
        added.assign(removed.begin(), removed.begin() + static_cast<std::ptrdiff_t>(reused));
        for (std::size_t next = cells; added.size() < added_cells; ++next) {
            added.push_back(static_cast<Index>(next));
        }
        std::size_t last = cells;
        std::size_t end = removed.size();
        for (std::size_t hole = reused; hole < end; ++hole) {
            while (end > hole && removed[end - 1] == last - 1) { // the last cell is a hole itself
                --last;
                --end;
            }
            if (hole < end) {
                moves.push_back({static_cast<Index>(--last), removed[hole]});
            }
        }
    }

    /// The number of a cell that is kept.
    Index now_of(Index before) const {
        const auto move = std::lower_bound(moves.begin(), moves.end(), before,
                                           [](const Move& m, Index cell) { return m.before > cell; });
        return move != moves.end() && move->before == before ? move->now : before;
    }

    /// Replaces the rows of an array.
    template<class Row>
    void apply(Array<Row>& rows, std::span<const Row> new_rows) const {
        rows.resize(std::max(rows.size(), count));
        for (const Move& move : moves) {
            rows[move.now] = rows[move.before];
        }
        for (std::size_t k = 0; k < added.size(); ++k) {
            rows[added[k]] = new_rows[k];
        }
        rows.resize(count);
    }
};

} // namespace slabhull
