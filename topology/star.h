// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Numbers distinct keys 0, 1, 2 .. in the order they come. Made to be cleared and reused for many small
/// sets.
class LocalNumbering {
public:
    LocalNumbering() : table_(64, 0) {}

    void clear() {
        for (const Index slot : slots_) {
            table_[slot] = 0;
        }
        slots_.clear();
        keys_.clear();
    }

    /// Number of `key`; a new one gets the next.
    Index number(Index key) {
        Index slot = home(key);
        while (table_[slot] != 0) {
            if (keys_[table_[slot] - 1] == key) {
                return table_[slot] - 1;
            }
            slot = (slot + 1) & mask();
        }
        return append(key, slot);
    }

    std::span<const Index> keys() const { return keys_; }
    std::size_t size() const { return keys_.size(); }

private:
    Index mask() const { return static_cast<Index>(table_.size() - 1); }
    Index home(Index key) const { return static_cast<Index>((key * 0x9E3779B97F4A7C15u) >> 32) & mask(); }

    Index append(Index key, Index slot) {
        keys_.push_back(key);
        table_[slot] = static_cast<Index>(keys_.size());
        slots_.push_back(slot);
        if (2 * keys_.size() > table_.size()) {
            grow();
        }
        return static_cast<Index>(keys_.size() - 1);
    }

    void grow() {
        table_.assign(4 * table_.size(), 0);
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            Index slot = home(keys_[k]);
            while (table_[slot] != 0) {
                slot = (slot + 1) & mask();
            }
            table_[slot] = static_cast<Index>(k + 1);
            slots_[k] = slot;
        }
    }

    std::vector<Index> table_; ///< number + 1, or 0 for a free slot
    std::vector<Index> slots_; ///< where each key is
    std::vector<Index> keys_;
};

/// Walks the star of a vertex, from cell to cell through the facets at the vertex.
template<int D>
class StarWalker {
public:
    StarWalker(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors)
        : cells_{cells}, neighbors_{neighbors} {}

    /// The cells that can be reached from `first`, a cell of `vertex`. Valid until the next walk.
    std::span<const Index> walk(Index vertex, Index first) {
        met_.clear();
        met_.number(first);
        for (std::size_t k = 0; k < met_.size(); ++k) {
            const Index c = met_.keys()[k];
            for (std::size_t i = 0; i <= D; ++i) {
                if (cells_[c][i] != vertex && neighbors_[c][i] != no_index) {
                    met_.number(neighbors_[c][i]);
                }
            }
        }
        return met_.keys();
    }

private:
    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    LocalNumbering met_;
};

} // namespace slabhull
