// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace slabhull {

/// Cells filed in rows (under vertices, say), compressed. Ascending in each row.
struct CellLists {
    Array<std::uint64_t> begin; ///< row_count + 1 entries
    Array<Index> cells;

    std::span<const Index> of(std::size_t row) const {
        return {cells.data() + begin[row], static_cast<std::size_t>(begin[row + 1] - begin[row])};
    }
};

/// Files each cell in the rows that `rows(cell, file)` hands to file(row).
/// Two passes of counting sort, so `rows` must say the same twice. Each thread takes one part of the cells
/// and has its own counters, 8 bytes for each row.
template<class Rows>
CellLists list_cells(std::size_t cell_count, std::size_t row_count, const Rows& rows) {
    const auto parts = static_cast<std::size_t>(thread_count());
    const std::size_t part_size = std::max<std::size_t>(1, (cell_count + parts - 1) / parts);
    Array<std::uint64_t> next; // by part and row
    next.assign(parts * row_count, 0);
    parallel_for(cell_count, part_size, [&](std::size_t begin, std::size_t end) {
        std::uint64_t* const count = next.data() + begin / part_size * row_count;
        for (std::size_t c = begin; c < end; ++c) {
            rows(c, [count](std::size_t row) { ++count[row]; });
        }
    });
    CellLists lists;
    lists.begin.resize(row_count + 1);
    std::uint64_t sum = 0;
    for (std::size_t row = 0; row < row_count; ++row) {
        lists.begin[row] = sum;
        for (std::size_t k = row; k < next.size(); k += row_count) {
            sum += std::exchange(next[k], sum);
        }
    }
    lists.begin[row_count] = sum;
    lists.cells.resize(sum);
    parallel_for(cell_count, part_size, [&](std::size_t begin, std::size_t end) {
        std::uint64_t* const place = next.data() + begin / part_size * row_count;
        for (std::size_t c = begin; c < end; ++c) {
            rows(c,
                 [&lists, place, c](std::size_t row) { lists.cells[place[row]++] = static_cast<Index>(c); });
        }
    });
    return lists;
}

} // namespace slabhull
