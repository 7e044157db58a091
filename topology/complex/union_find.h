// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <numeric>
#include <span>

namespace slabhull {

/// Disjoint sets of 0 .. count - 1, which many threads may join at once (Anderson and Woll, STOC 1991). A set
/// is represented by its smallest element, whatever the order of joining.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }

    /// Path halving. What is not a root never becomes one again, so a late store does no harm.
    Index find(Index x) {
        for (Index parent = load(x); parent != x;) {
            const Index next = load(parent);
            at(x).store(next, std::memory_order_relaxed);
            x = next;
            parent = load(x);
        }
        return x;
    }

    /// False when they were in one set already.
    bool join(Index a, Index b) {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b) {
                return false;
            }
            Index root = std::max(a, b);
            if (at(root).compare_exchange_strong(root, std::min(a, b), std::memory_order_relaxed)) {
                return true;
            }
        }
    }

    bool is_root(Index x) const { return parent_[x] == x; }

    std::size_t count_sets() const {
        std::size_t sets = 0;
        for (std::size_t x = 0; x < parent_.size(); ++x) {
            sets += parent_[x] == x;
        }
        return sets;
    }

private:
    std::atomic_ref<Index> at(Index x) { return std::atomic_ref{parent_[x]}; }
    Index load(Index x) { return at(x).load(std::memory_order_relaxed); }

    Array<Index> parent_;
};

/// The vertices of cells, joined by these.
template<std::size_t N>
UnionFind joined_vertices(std::span<const std::array<Index, N>> cells, std::size_t vertex_count) {
    constexpr std::size_t grain = 1 << 16;
    UnionFind joined{vertex_count};
    parallel_for(cells.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            for (std::size_t i = 1; i < N; ++i) {
                joined.join(cells[c][0], cells[c][i]);
            }
        }
    });
    return joined;
}

} // namespace slabhull
