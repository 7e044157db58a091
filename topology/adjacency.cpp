// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/adjacency.h"

#include "cell_lists.h"
#include "slabhull/core/parallel.h"
#include "sorted_cell.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace slabhull {

namespace {

constexpr std::size_t vertices_per_piece = 1 << 13;

/// One side of a facet: a cell and the facet's place in it. The facet's smallest vertex is that of the
/// bucket.
struct HalfFacet {
    std::uint64_t others; ///< the facet's other vertices, ascending, 32 bits each
    Index cell;
    std::uint8_t place;
    bool odd; ///< SortedCell::facet_odd
    bool matched;
};

template<int D>
HalfFacet half_facet(const SortedCell<D>& cell, std::size_t k, Index number) {
    const Facet<D> facet = cell.facet(k);
    std::uint64_t others = 0;
    for (std::size_t i = 1; i < D; ++i) {
        others = others << 32 | facet[i];
    }
    return {others, number, cell.place[k], cell.facet_odd(k), false};
}

/// Facets are compared only with facets of the same smallest vertex. In sorted order, vertex 0 is the
/// smallest of all facets but the one opposite to it, whose smallest is vertex 1: a cell is filed under these
/// two.
template<int D>
CellLists buckets_by_smallest_vertex(std::span<const Simplex<D>> cells, std::size_t vertex_count) {
    return list_cells(cells.size(), vertex_count, [&](std::size_t c, const auto& file) {
        Index smallest = std::min(cells[c][0], cells[c][1]);
        Index second = std::max(cells[c][0], cells[c][1]);
        for (std::size_t i = 2; i <= D; ++i) {
            second = std::min(second, std::max(smallest, cells[c][i]));
            smallest = std::min(smallest, cells[c][i]);
        }
        file(smallest);
        if (second != smallest) {
            file(second);
        }
    });
}

/// Matches the half-facets of one bucket after another; one matcher per thread and piece.
template<int D>
class BucketMatcher {
public:
    BucketMatcher(std::span<const Simplex<D>> cells, Adjacency<D>& result) : cells_{cells}, result_{result} {}

    void match(Index vertex, std::span<const Index> bucket) {
        gather(vertex, bucket);
        if (halves_.size() > hashed_limit || !match_by_hashing()) {
            match_by_sorting(vertex);
        }
    }

    std::vector<FacetDefect<D>> defects;

private:
    static constexpr std::size_t hashed_limit = 1024;

    void gather(Index vertex, std::span<const Index> bucket) {
        halves_.clear();
        for (const Index c : bucket) {
            const SortedCell<D> cell = sort_cell<D>(cells_[c]);
            if (cell.vertices[0] == vertex) {
                for (std::size_t k = 1; k <= D; ++k) {
                    halves_.push_back(half_facet(cell, k, c));
                }
            }
            if (cell.vertices[1] == vertex) {
                halves_.push_back(half_facet(cell, 0, c));
            }
        }
    }

    /// The quick way for sound buckets. Returns false when some facet is not in exactly two agreeing cells.
    bool match_by_hashing() {
        int bits = 3;
        while ((std::size_t{1} << bits) < 2 * halves_.size()) {
            ++bits;
        }
        const std::size_t mask = (std::size_t{1} << bits) - 1;
        std::fill_n(table_.begin(), mask + 1, vacant);
        std::size_t unmatched = 0;
        for (std::size_t k = 0; k < halves_.size(); ++k) {
            std::size_t slot = (halves_[k].others * 0x9E3779B97F4A7C15u) >> (64 - bits);
            while (table_[slot] != vacant && halves_[table_[slot]].others != halves_[k].others) {
                slot = (slot + 1) & mask;
            }
            if (table_[slot] == vacant) {
                table_[slot] = static_cast<std::uint16_t>(k);
                ++unmatched;
                continue;
            }
            HalfFacet& first = halves_[table_[slot]];
            if (first.matched || first.odd == halves_[k].odd) {
                return false;
            }
            first.matched = true;
            --unmatched;
            join(first, halves_[k]);
        }
        return unmatched == 0;
    }

    /// The sure way: never quadratic, and finds every defect. Overrules what hashing may have joined.
    void match_by_sorting(Index vertex) {
        std::sort(halves_.begin(), halves_.end(), [](const HalfFacet& a, const HalfFacet& b) {
            return a.others != b.others ? a.others < b.others
                                        : std::pair{a.cell, a.place} < std::pair{b.cell, b.place};
        });
        for (auto run = halves_.begin(); run != halves_.end();) {
            const auto end =
                std::find_if(run, halves_.end(), [&](const HalfFacet& h) { return h.others != run->others; });
            settle(vertex, {run, end});
            run = end;
        }
    }

    /// `run` is all sides of one facet.
    void settle(Index vertex, std::span<const HalfFacet> run) {
        using Kind = typename FacetDefect<D>::Kind;
        if (run.size() == 2) {
            join(run[0], run[1]);
            if (run[0].odd == run[1].odd) {
                report(Kind::disoriented, vertex, run);
            }
            return;
        }
        for (const HalfFacet& half : run) {
            result_.neighbors[half.cell][half.place] = no_index;
        }
        report(run.size() == 1 ? Kind::open : Kind::overfull, vertex, run);
    }

    void report(typename FacetDefect<D>::Kind kind, Index vertex, std::span<const HalfFacet> run) {
        Facet<D> facet{};
        facet[0] = vertex;
        std::uint64_t others = run[0].others;
        for (std::size_t i = D; i-- > 1; others >>= 32) {
            facet[i] = static_cast<Index>(others);
        }
        std::vector<Index> in;
        std::transform(run.begin(), run.end(), std::back_inserter(in),
                       [](const HalfFacet& h) { return h.cell; });
        defects.push_back({kind, facet, std::move(in)});
    }

    void join(const HalfFacet& a, const HalfFacet& b) {
        result_.neighbors[a.cell][a.place] = b.cell;
        result_.neighbors[b.cell][b.place] = a.cell;
    }

    static constexpr std::uint16_t vacant = std::numeric_limits<std::uint16_t>::max();
    std::span<const Simplex<D>> cells_;
    Adjacency<D>& result_;
    std::vector<HalfFacet> halves_;
    std::array<std::uint16_t, 2 * hashed_limit> table_;
};

} // namespace

template<int D>
Adjacency<D> build_adjacency(std::span<const Simplex<D>> cells, std::size_t vertex_count) {
    checked_index(cells.size(), "cells");
    const CellLists buckets = buckets_by_smallest_vertex<D>(cells, vertex_count);
    Adjacency<D> result;
    result.neighbors.resize(cells.size()); // each half-facet is in one bucket, which writes its entry
    const std::size_t pieces = (vertex_count + vertices_per_piece - 1) / vertices_per_piece;
    std::vector<std::vector<FacetDefect<D>>> defects(pieces);
    parallel_for(vertex_count, vertices_per_piece, [&](std::size_t begin, std::size_t end) {
        BucketMatcher<D> matcher{cells, result};
        for (std::size_t v = begin; v < end; ++v) {
            matcher.match(static_cast<Index>(v), buckets.of(v));
        }
        defects[begin / vertices_per_piece] = std::move(matcher.defects);
    });
    for (std::vector<FacetDefect<D>>& found : defects) {
        std::move(found.begin(), found.end(), std::back_inserter(result.defects));
    }
    return result;
}

template Adjacency<1> build_adjacency<1>(std::span<const Simplex<1>>, std::size_t);
template Adjacency<2> build_adjacency<2>(std::span<const Simplex<2>>, std::size_t);
template Adjacency<3> build_adjacency<3>(std::span<const Simplex<3>>, std::size_t);

} // namespace slabhull
