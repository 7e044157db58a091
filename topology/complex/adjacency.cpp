// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/adjacency.h"

#include "core/hash.h"
#include "core/pieces.h"
#include "topology/complex/cell_lists.h"
#include "topology/complex/sorted_cell.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <tuple>

namespace slabhull {

namespace {

// Facets are compared only with facets whose smallest vertex is in the same bucket.
constexpr int bucket_bits = 4;
constexpr std::size_t bucket_size = std::size_t{1} << bucket_bits; // vertices: some 400 half-facets, 6 KiB
constexpr std::size_t buckets_per_piece = 512;

/// The vertices of a facet but the smallest, ascending, 32 bits each.
template<int D>
struct OtherVertices {
    using Packed = std::uint64_t;
    static std::uint64_t folded(Packed others) { return others; }
};
template<>
struct OtherVertices<4> { // three do not fit into 64 bits
    __extension__ typedef unsigned __int128 Packed;
    static std::uint64_t folded(Packed others) {
        return static_cast<std::uint64_t>(others) ^
               static_cast<std::uint64_t>(others >> 64) * 0xD6E8FEB86659FD93u;
    }
};

/// One side of a facet: a cell and the facet's place in it.
template<int D>
struct HalfFacet {
    enum State : std::uint8_t { alone, joined, at_fault };
    typename OtherVertices<D>::Packed others;
    Index cell;
    std::uint16_t first;   ///< while hashing: the first side met of this facet, which keeps its state
    std::uint8_t smallest; ///< the facet's smallest vertex, counted from the bucket's first
    std::uint8_t place : 3;
    bool odd : 1; ///< SortedCell::facet_odd
    State state : 2;

    bool same_facet(const HalfFacet& h) const { return others == h.others && smallest == h.smallest; }
};

template<int D>
HalfFacet<D> half_facet(const SortedCell<D>& cell, std::size_t k, Index number) {
    const Facet<D> facet = cell.facet(k);
    typename OtherVertices<D>::Packed others = 0;
    for (std::size_t i = 1; i < D; ++i) {
        others = others << 32 | facet[i];
    }
    const auto smallest = static_cast<std::uint8_t>(facet[0] % bucket_size);
    return {others, number, 0, smallest, cell.place[k], cell.facet_odd(k), HalfFacet<D>::alone};
}

/// In sorted order, vertex 0 is the smallest of all facets but the one opposite to it, whose smallest is
/// vertex 1: a cell is filed under these two.
template<int D>
CellLists buckets_by_smallest_vertex(std::span<const Simplex<D>> cells, std::size_t bucket_count) {
    return list_cells(cells.size(), bucket_count, [&](std::size_t c, const auto& file) {
        Index smallest = std::min(cells[c][0], cells[c][1]);
        Index second = std::max(cells[c][0], cells[c][1]);
        for (std::size_t i = 2; i <= D; ++i) {
            second = std::min(second, std::max(smallest, cells[c][i]));
            smallest = std::min(smallest, cells[c][i]);
        }
        file(smallest >> bucket_bits);
        if (second >> bucket_bits != smallest >> bucket_bits) {
            file(second >> bucket_bits);
        }
    });
}

/// Matches the half-facets of one bucket after another; one matcher per thread and piece.
template<int D>
class BucketMatcher {
    using Half = HalfFacet<D>;

public:
    BucketMatcher(std::span<const Simplex<D>> cells, const CellLists& buckets, Adjacency<D>& result)
        : cells_{cells}, buckets_{buckets}, result_{result} {}

    void match(std::size_t bucket) {
        gather(bucket);
        if (halves_.size() > hashed_limit) {
            faulty_.assign(halves_.begin(), halves_.end());
        } else {
            match_by_hashing();
        }
        settle_faulty(static_cast<Index>(bucket * bucket_size));
    }

    std::vector<FacetDefect<D>> defects;

private:
    static constexpr std::size_t hashed_limit = 1 << 14;
    static constexpr std::uint16_t vacant = std::numeric_limits<std::uint16_t>::max();

    /// The cells of a bucket lie anywhere in memory, so they and their entries in the result are prefetched.
    /// Branch-free: what is written for facets of other buckets is overwritten later.
    void gather(std::size_t bucket) {
        constexpr std::size_t ahead = 64;
        const std::span<const Index> all = buckets_.cells;
        const std::size_t last = all.size() - 1;
        const std::size_t end = buckets_.begin[bucket + 1];
        halves_.resize((D + 1) * (buckets_.of(bucket).size() + 1));
        std::size_t count = 0;
        for (std::size_t i = buckets_.begin[bucket]; i < end; ++i) {
            const Index soon = all[std::min(i + ahead, last)];
            __builtin_prefetch(&cells_[soon]);
            __builtin_prefetch(&result_.neighbors[soon], 1);
            const SortedCell<D> cell = sort_cell<D>(cells_[all[i]]);
            for (std::size_t k = 1; k <= D; ++k) {
                halves_[count + k - 1] = half_facet(cell, k, all[i]);
            }
            count += cell.vertices[0] >> bucket_bits == bucket ? D : 0;
            halves_[count] = half_facet(cell, 0, all[i]);
            count += cell.vertices[1] >> bucket_bits == bucket ? 1 : 0;
        }
        halves_.resize(count);
    }

    /// By hashing: joins the facets of exactly two agreeing cells and leaves the others in faulty_.
    void match_by_hashing() {
        const int bits = std::bit_width(2 * halves_.size() + 1);
        table_.assign(std::size_t{1} << bits, vacant);
        std::size_t pairs = 0;
        for (std::size_t k = 0; k < halves_.size(); ++k) {
            Half& half = halves_[k];
            std::uint16_t& slot = slot_of(half, bits);
            if (slot == vacant) {
                slot = half.first = static_cast<std::uint16_t>(k);
                continue;
            }
            half.first = slot;
            Half& first = halves_[slot];
            if (first.state == Half::alone && first.odd != half.odd) {
                first.state = Half::joined;
                ++pairs;
                join(first, half);
            } else {
                first.state = Half::at_fault;
            }
        }
        if (2 * pairs != halves_.size()) {
            std::copy_if(halves_.begin(), halves_.end(), std::back_inserter(faulty_),
                         [&](const Half& h) { return halves_[h.first].state != Half::joined; });
        }
    }

    /// The slot that holds the first side of this facet, or the vacant one for it.
    std::uint16_t& slot_of(const Half& half, int bits) {
        const std::uint64_t key = OtherVertices<D>::folded(half.others) ^ std::uint64_t{half.smallest}
                                                                              << (64 - bucket_bits);
        std::size_t slot = hash_slot(key, bits);
        while (table_[slot] != vacant && !halves_[table_[slot]].same_facet(half)) {
            slot = (slot + 1) & (table_.size() - 1);
        }
        return table_[slot];
    }

    /// By sorting: never quadratic, finds every defect, and overrules what hashing may have joined.
    void settle_faulty(Index first_vertex) {
        const auto key = [](const Half& h) { return std::tuple{h.smallest, h.others, h.cell, +h.place}; };
        std::sort(faulty_.begin(), faulty_.end(),
                  [&](const Half& a, const Half& b) { return key(a) < key(b); });
        for (auto run = faulty_.begin(); run != faulty_.end();) {
            const auto end =
                std::find_if(run, faulty_.end(), [&](const Half& h) { return !h.same_facet(*run); });
            settle(first_vertex + run->smallest, {run, end});
            run = end;
        }
        faulty_.clear();
    }

    /// `run`: all sides of one facet.
    void settle(Index smallest, std::span<const Half> run) {
        using Kind = typename FacetDefect<D>::Kind;
        if (run.size() == 2) {
            join(run[0], run[1]);
            if (run[0].odd == run[1].odd) {
                report(Kind::disoriented, smallest, run);
            }
            return;
        }
        for (const Half& half : run) {
            result_.neighbors[half.cell][half.place] = no_index;
        }
        report(run.size() == 1 ? Kind::open : Kind::overfull, smallest, run);
    }

    void report(typename FacetDefect<D>::Kind kind, Index smallest, std::span<const Half> run) {
        Facet<D> facet{};
        facet[0] = smallest;
        auto others = run[0].others;
        for (std::size_t i = D; i-- > 1; others >>= 32) {
            facet[i] = static_cast<Index>(others);
        }
        std::vector<Index> in;
        std::transform(run.begin(), run.end(), std::back_inserter(in), [](const Half& h) { return h.cell; });
        defects.push_back({kind, facet, std::move(in)});
    }

    void join(const Half& a, const Half& b) {
        result_.neighbors[a.cell][a.place] = b.cell;
        result_.neighbors[b.cell][b.place] = a.cell;
    }

    std::span<const Simplex<D>> cells_;
    const CellLists& buckets_;
    Adjacency<D>& result_;
    Array<Half> halves_; // resized without clearing
    std::vector<Half> faulty_;
    std::vector<std::uint16_t> table_;
};

} // namespace

template<int D>
Adjacency<D> build_adjacency(std::span<const Simplex<D>> cells, std::size_t vertex_count) {
    checked_index(cells.size(), "cells");
    const std::size_t bucket_count = (vertex_count + bucket_size - 1) / bucket_size;
    const CellLists buckets = buckets_by_smallest_vertex<D>(cells, bucket_count);
    Adjacency<D> result;
    result.neighbors.resize(cells.size()); // each half-facet is in one bucket, which writes its entry
    result.defects = parallel_gather<FacetDefect<D>>(
        bucket_count, buckets_per_piece,
        [&](std::size_t begin, std::size_t end, std::vector<FacetDefect<D>>& defects) {
            BucketMatcher<D> matcher{cells, buckets, result};
            for (std::size_t bucket = begin; bucket < end; ++bucket) {
                matcher.match(bucket);
            }
            defects = std::move(matcher.defects);
        });
    return result;
}

template Adjacency<1> build_adjacency<1>(std::span<const Simplex<1>>, std::size_t);
template Adjacency<2> build_adjacency<2>(std::span<const Simplex<2>>, std::size_t);
template Adjacency<3> build_adjacency<3>(std::span<const Simplex<3>>, std::size_t);
template Adjacency<4> build_adjacency<4>(std::span<const Simplex<4>>, std::size_t);

} // namespace slabhull
