// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// A set of indices, cleared in no time; small enough to stay in the first cache.
class MarkSet {
public:
    MarkSet() : table_(std::size_t{1} << bits_) {}

    void clear() {
        size_ = 0;
        if (++epoch_ == 0) { // marks of the first epoch would seem to be of this one
            table_.assign(table_.size(), 0);
            epoch_ = 1;
        }
    }

    /// 1 when the key is new, else 0: a number, since a branch on it would be mispredicted half of the time.
    std::size_t insert(Index key) {
        const std::uint64_t wanted = entry(key);
        std::size_t at = home(key);
        while (taken(table_[at]) && table_[at] != wanted) {
            at = (at + 1) & (table_.size() - 1);
        }
        const std::size_t is_new = table_[at] != wanted ? 1 : 0;
        table_[at] = wanted;
        size_ += is_new;
        return is_new;
    }

    /// Makes room for `more` keys; to be called before so many are inserted.
    void reserve(std::size_t more) {
        if (4 * (size_ + more) > table_.size()) {
            grow();
        }
    }

    std::size_t size() const { return size_; }

private:
    /// An entry holds its epoch and the key; those of other epochs are vacant.
    std::uint64_t entry(Index key) const { return std::uint64_t{epoch_} << 32 | key; }
    bool taken(std::uint64_t slot) const { return slot >> 32 == epoch_; }
    std::size_t home(Index key) const { return (key * 0x9E3779B97F4A7C15u) >> (64 - bits_); }

    void grow() {
        const std::vector<std::uint64_t> before = std::exchange(table_, {});
        bits_ += 2;
        table_.resize(std::size_t{1} << bits_);
        size_ = 0;
        for (const std::uint64_t slot : before) {
            if (taken(slot)) {
                insert(static_cast<Index>(slot));
            }
        }
    }

    int bits_ = 9;
    std::vector<std::uint64_t> table_;
    std::size_t size_ = 0;
    Index epoch_ = 1;
};

/// Counts the stars of vertices. StarWalker tells which cells are in one; this only counts, twice as fast.
/// Needs: neighbours that share the facets they are said to share.
template<int D>
class StarCounter {
public:
    StarCounter(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors)
        : cells_{cells}, neighbors_{neighbors}, reached_(64) {}

    struct Count {
        std::size_t cells;    ///< reached from the first through facets at the vertex
        std::size_t vertices; ///< of those cells, without the vertex itself
    };

    /// A cell that is reached through a facet has one vertex only that may be new, the one opposite to it.
    Count count(Index vertex, Index first) {
        met_cells_.clear();
        met_vertices_.clear();
        std::size_t reached = 0;
        const auto reach = [&](Index cell, Index facet) {
            prefetch(cell);
            reached_[reached] = {cell, facet};
            reached += met_cells_.insert(cell);
        };
        for (const Index w : cells_[first]) {
            met_vertices_.insert(w);
        }
        reach(first, parity(cells_[first]) ^ vertex);
        for (std::size_t k = 0; k < reached; ++k) {
            make_room(reached);
            const auto [cell, facet] = reached_[k];
            const Simplex<D>& corners = cells_[cell];
            const Index all = parity(corners);
            met_vertices_.insert(all ^ facet);
            std::size_t place = place_of(vertex, corners);
            for (std::size_t step = 0; step < D; ++step) {
                place = place == D ? 0 : place + 1;
                const Index across = neighbors_[cell][place];
                reach(across != no_index ? across : cell, all ^ corners[place]);
            }
        }
        return {reached, met_vertices_.size() - 1};
    }

    /// To be called some time before a cell is looked at.
    void prefetch(Index cell) const {
        __builtin_prefetch(&cells_[cell]);
        __builtin_prefetch(&neighbors_[cell]);
    }

private:
    struct Reached {
        Index cell;
        Index facet; ///< parity of the vertices of the facet through which it was reached
    };

    /// Exclusive or: that of a cell and that of one of its facets give the vertex that the facet leaves out.
    static Index parity(const Simplex<D>& corners) {
        Index result = 0;
        for (const Index w : corners) {
            result ^= w;
        }
        return result;
    }

    static std::size_t place_of(Index vertex, const Simplex<D>& corners) {
        std::size_t place = 0;
        for (std::size_t i = 1; i <= D; ++i) {
            place = corners[i] == vertex ? i : place;
        }
        return place;
    }

    void make_room(std::size_t reached) {
        if (reached + D + 1 > reached_.size()) {
            reached_.resize(2 * reached_.size());
        }
        met_cells_.reserve(D);
        met_vertices_.reserve(1);
    }

    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    MarkSet met_cells_;
    MarkSet met_vertices_;
    std::vector<Reached> reached_; ///< room for one beyond those reached
};

/// Lends things that are dear to make to the pieces of a parallel loop, so that each thread makes one at
/// most.
template<class T>
class Lender {
public:
    template<class Make>
    std::unique_ptr<T> take(const Make& make) {
        const std::lock_guard guard{lock_};
        if (idle_.empty()) {
            return std::make_unique<T>(make());
        }
        std::unique_ptr<T> taken = std::move(idle_.back());
        idle_.pop_back();
        return taken;
    }
    void give_back(std::unique_ptr<T> thing) {
        const std::lock_guard guard{lock_};
        idle_.push_back(std::move(thing));
    }

private:
    std::mutex lock_;
    std::vector<std::unique_ptr<T>> idle_;
};

} // namespace slabhull
