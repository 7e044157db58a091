// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/parallel.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Cells filed under vertices, in compressed rows. The order inside a row depends on the threads: use it as a
/// set.
struct CellLists {
    Array<std::uint64_t> begin; ///< vertex_count + 1 entries
    Array<Index> cells;

    std::span<const Index> of(std::size_t vertex) const {
        return {cells.data() + begin[vertex], static_cast<std::size_t>(begin[vertex + 1] - begin[vertex])};
    }
};

namespace detail {

inline constexpr std::size_t cells_per_piece = 1 << 16;

/// Old value of a counter that other threads may be counting on, too. Alone, we save the locked instruction.
inline std::uint64_t count_up(std::uint64_t& counter, bool alone) {
    if (alone) {
        return counter++;
    }
    return std::atomic_ref{counter}.fetch_add(1, std::memory_order_relaxed);
}

inline std::uint64_t count_down(std::uint64_t& counter, bool alone) {
    if (alone) {
        return --counter;
    }
    return std::atomic_ref{counter}.fetch_sub(1, std::memory_order_relaxed) - 1;
}

} // namespace detail

/// Files each cell under the vertices that `keys(cell, file)` hands to file(vertex).
/// Two passes of counting sort, so `keys` must say the same twice.
template<class Keys>
CellLists list_cells(std::size_t cell_count, std::size_t vertex_count, const Keys& keys) {
    const bool alone = thread_count() == 1;
    CellLists lists;
    lists.begin.assign(vertex_count + 1, 0);
    parallel_for(cell_count, detail::cells_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            keys(c, [&](Index vertex) { detail::count_up(lists.begin[vertex], alone); });
        }
    });
    // Row ends; filling backwards from them turns them into row beginnings.
    std::uint64_t sum = 0;
    for (std::uint64_t& end : lists.begin) {
        end = sum += end;
    }
    lists.cells.resize(sum);
    parallel_for(cell_count, detail::cells_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            keys(c, [&](Index vertex) {
                lists.cells[detail::count_down(lists.begin[vertex], alone)] = static_cast<Index>(c);
            });
        }
    });
    return lists;
}

} // namespace slabhull
