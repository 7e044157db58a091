// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace slabhull {

/// Disjoint sets of 0 .. count - 1. A set is represented by its smallest element, whatever the order of
/// joining.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }

    Index find(Index x) {
        while (parent_[x] != x) {
            parent_[x] = parent_[parent_[x]];
            x = parent_[x];
        }
        return x;
    }

    /// False when they were in one set already.
    bool join(Index a, Index b) {
        a = find(a);
        b = find(b);
        if (a == b) {
            return false;
        }
        parent_[std::max(a, b)] = std::min(a, b);
        return true;
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
    Array<Index> parent_;
};

} // namespace slabhull
