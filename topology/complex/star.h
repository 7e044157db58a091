// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/hash.h"
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
    LocalNumbering() : table_(256), keys_(table_.size()) {}

    void clear() {
        size_ = 0;
        if (++epoch_ == 0) { // slots of the first epoch would seem to be of this one
            table_.assign(table_.size(), Slot{});
            epoch_ = 1;
        }
    }

    /// Number of `key`; a new one gets the next.
    Index number(Index key) {
        Index at = home(key);
        while (table_[at].epoch == epoch_) {
            if (table_[at].key == key) {
                return table_[at].number;
            }
            at = (at + 1) & mask();
        }
        table_[at] = {key, epoch_, size_};
        keys_[size_++] = key;
        if (4 * std::size_t{size_} > table_.size()) {
            grow();
        }
        return size_ - 1;
    }

    std::span<const Index> keys() const { return {keys_.data(), size_}; }
    std::size_t size() const { return size_; }

private:
    /// Taken when its epoch is the present one, so that clearing costs nothing.
    struct Slot {
        Index key = 0;
        Index epoch = 0;
        Index number = 0;
    };

    Index mask() const { return static_cast<Index>(table_.size() - 1); }
    Index home(Index key) const { return static_cast<Index>(multiplied_hash(key) >> 32) & mask(); }

    void grow() {
        const std::vector<Index> keys{keys_.begin(), keys_.begin() + size_};
        table_.assign(4 * table_.size(), Slot{});
        keys_.resize(table_.size());
        size_ = 0;
        for (const Index key : keys) {
            number(key);
        }
    }

    std::vector<Slot> table_;
    std::vector<Index> keys_; ///< the first size_ of them
    Index size_ = 0;
    Index epoch_ = 1;
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
