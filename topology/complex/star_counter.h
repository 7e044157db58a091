// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/hash.h"
#include "slabhull/core/point.h"
#include "topology/complex/corners.h"
#include "topology/complex/whole_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// A set of numbers that is cleared in constant time and fits the first-level cache.
template<class Key>
class MarkSet {
public:
    MarkSet() : table_(std::size_t{1} << bits_) {}

    void clear() {
        size_ = 0;
        if (++epoch_ == 0) { // marks of the first epoch would seem to be of this one
            table_.assign(table_.size(), {});
            epoch_ = 1;
        }
    }

    /// 1 when the key is new, else 0: a number, since a branch on it would be mispredicted half of the time.
    std::size_t insert(Key key) {
        std::size_t at = home(key);
        while (taken(table_[at]) && table_[at].key != key) {
            at = (at + 1) & (table_.size() - 1);
        }
        const std::size_t is_new = taken(table_[at]) ? 0 : 1;
        table_[at] = {key, epoch_};
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
    struct Slot {
        Key key = 0;
        Index epoch = 0; ///< slots of other epochs are vacant
    };
    bool taken(const Slot& slot) const { return slot.epoch == epoch_; }
    std::size_t home(Key key) const { return hash_slot(key, bits_); }

    void grow() {
        const std::vector<Slot> before = std::exchange(table_, {});
        bits_ += 2;
        table_.resize(std::size_t{1} << bits_);
        size_ = 0;
        for (const Slot& slot : before) {
            if (taken(slot)) {
                insert(slot.key);
            }
        }
    }

    int bits_ = 9;
    std::vector<Slot> table_;
    std::size_t size_ = 0;
    Index epoch_ = 1;
};

/// Counts the stars of vertices. StarWalker tells which cells are in one; this only counts, which is
/// faster. Needs: neighbours that share the facets they are said to share, and are so mutually.
template<int D, class Mesh = WholeMesh<D>>
class StarCounter {
public:
    explicit StarCounter(const Mesh& mesh) : mesh_{mesh}, reached_(64) {}

    struct Count {
        std::size_t cells;    ///< reached from the first through facets at the vertex
        std::size_t vertices; ///< of those cells, without the vertex itself
        bool facet_twice;     ///< two pairs of neighbours have one facet, whose smallest vertex it is
    };

    /// A quick walk may mistake two facets for one; then it is repeated exactly, which is rare.
    Count count(Index vertex, Index first) {
        Count counted = walk(vertex, first, quick_facets_);
        if (counted.facet_twice) {
            counted = walk(vertex, first, sure_facets_);
        }
        return counted;
    }

    /// Prefetches a cell that is looked at soon.
    void prefetch(Index cell) const { mesh_.prefetch(cell); }

private:
    struct Reached {
        Index cell;
        Index facet; ///< parity of the vertices of the facet through which it was reached
    };

    /// The local numbers of a simplex without two of them.
    static constexpr auto other_places = [] {
        std::array<std::array<std::array<std::uint8_t, D - 1>, D + 1>, D + 1> table{};
        for (std::size_t a = 0; a <= D; ++a) {
            for (std::size_t b = 0; b <= D; ++b) {
                std::size_t found = 0;
                for (std::size_t place = 0; place <= D && found < D - 1; ++place) {
                    if (place != a && place != b) {
                        table[a][b][found++] = static_cast<std::uint8_t>(place);
                    }
                }
            }
        }
        return table;
    }();

    /// Facets at the vertex, by their other vertices: tells, branch-free, whether two may be the same.
    class QuickFacets {
    public:
        void clear() {
            bits_ = {};
            twice_ = 0;
        }
        void insert(std::uint64_t others, bool counts) {
            const std::uint64_t hash = multiplied_hash(others);
            std::uint64_t& word = bits_[hash >> (64 - word_bits)];
            const std::uint64_t bit = std::uint64_t{counts} << (hash >> (58 - word_bits) & 63);
            twice_ |= word & bit;
            word |= bit;
        }
        void reserve(std::size_t) {}
        bool twice() const { return twice_ != 0; }

    private:
        static constexpr int word_bits = 6;
        std::array<std::uint64_t, std::size_t{1} << word_bits> bits_{};
        std::uint64_t twice_ = 0;
    };

    /// The same, exactly.
    class SureFacets {
    public:
        void clear() {
            set_.clear();
            count_ = 0;
        }
        void insert(std::uint64_t others, bool counts) {
            if (counts) {
                set_.insert(others);
                ++count_;
            }
        }
        void reserve(std::size_t more) { set_.reserve(more); }
        bool twice() const { return set_.size() != count_; }

    private:
        MarkSet<std::uint64_t> set_;
        std::size_t count_ = 0;
    };

    /// A cell that is reached through a facet has one vertex only that may be new, the one opposite to it,
    /// and two facets at the vertex that remain to be looked through (D = 3; one for D = 2).
    template<class Facets>
    Count walk(Index vertex, Index first, Facets& facets) {
        met_cells_.clear();
        met_vertices_.clear();
        facets.clear();
        reached_[0] = {first, 0};
        std::size_t reached = met_cells_.insert(first);
        const auto look_through = [&](Index cell, const Simplex<D>& corners, std::size_t at,
                                      std::size_t place, Index all) {
            const Index neighbor = mesh_.neighbor(cell, place);
            const Index across = neighbor != no_index ? neighbor : cell;
            prefetch(across);
            reached_[reached] = {across, all ^ corners[place]};
            const std::size_t is_new = met_cells_.insert(across);
            reached += is_new;
            const auto [others, smallest] = other_vertices(corners, other_places[at][place]);
            // A facet between two cells that were met is seen from both: count it once.
            facets.insert(others, (vertex < smallest) & ((is_new != 0) | (cell < across)));
        };
        const std::size_t at_first = place_of<D>(vertex, mesh_.cell(first));
        for (std::size_t place = 0; place <= D; ++place) {
            met_vertices_.insert(mesh_.cell(first)[place]);
            if (place != at_first) {
                look_through(first, mesh_.cell(first), at_first, place, parity<D>(mesh_.cell(first)));
            }
        }
        for (std::size_t k = 1; k < reached; ++k) {
            make_room(reached);
            facets.reserve(D);
            const auto [cell, facet] = reached_[k];
            const Simplex<D>& corners = mesh_.cell(cell);
            const Index all = parity<D>(corners);
            const Index apex = all ^ facet;
            met_vertices_.insert(apex);
            const std::size_t at = place_of<D>(vertex, corners);
            for (const std::uint8_t place : other_places[at][place_of<D>(apex, corners)]) {
                look_through(cell, corners, at, place, all);
            }
        }
        return {reached, met_vertices_.size() - 1, facets.twice()};
    }

    /// The vertices at the given places, as a key that does not depend on their order, and the smallest of
    /// them.
    static std::pair<std::uint64_t, Index> other_vertices(const Simplex<D>& corners,
                                                          const std::array<std::uint8_t, D - 1>& places) {
        if constexpr (D == 2) {
            return {corners[places[0]], corners[places[0]]};
        } else {
            const auto [a, b] = std::minmax(corners[places[0]], corners[places[1]]);
            return {std::uint64_t{b} << 32 | a, a};
        }
    }

    void make_room(std::size_t reached) {
        if (reached + D + 1 > reached_.size()) {
            reached_.resize(2 * reached_.size());
        }
        met_cells_.reserve(D);
        met_vertices_.reserve(1);
    }

    Mesh mesh_;
    MarkSet<Index> met_cells_;
    MarkSet<Index> met_vertices_;
    QuickFacets quick_facets_;
    SureFacets sure_facets_;
    std::vector<Reached> reached_; ///< room for one beyond those reached
};

} // namespace slabhull
