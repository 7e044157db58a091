// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/part_embedding.h"

#include "core/joined_spans.h"
#include "core/pieces.h"
#include "geometry/embedding/cell_groups.h"
#include "geometry/embedding/cell_pairs.h"
#include "geometry/embedding/embedded_caps.h"
#include "geometry/embedding/embedding_search.h"
#include "slab/check/part_exchange.h"
#include "slab/check/search_ghosts.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

/// The proof of embedded_caps.h for the caps of a hull in parts.
template<int D>
class CapsOfParts {
public:
    CapsOfParts(const HullPart<D>& part, Communicator& ranks) : part_{part}, ranks_{ranks} {
        std::array<double, 2> here = time_span<D>(part.points, part.cells);
        times_ = {ranks.min(here[0]), ranks.max(here[1])};
        caps_ = find_caps<D>(part.points, part.cells, times_);
        const auto outside = values_outside<CapOf>(part, ranks, [&](Index cell) { return caps_[cell]; });
        caps_.insert(caps_.end(), outside.begin(), outside.end());
    }

    /// Whether both caps are embedded and keep apart from the side. Two ranks take the longest step at once.
    bool are_embedded() const {
        const std::array<OfHull, 2> boundary{gather(CapOf::first), gather(CapOf::last)};
        const bool sound = together(ranks_, [&] {
            bool proven = true;
            for (std::size_t k = 0; k < 2; ++k) {
                proven = proven && boundary[k].sign != 0;
                if (ranks_.rank() == prover(k) && proven) {
                    proven = bound_a_domain<D>(boundary[k].facets, boundary[k].points, boundary[k].sign);
                }
                proven = proven && keeps_to(boundary[k], times_[k]);
            }
            return proven;
        });
        return ranks_.min(sound ? 1 : 0) == 1;
    }

    /// The cap of each cell of the part. Gives the list up.
    Array<CapOf> take_caps() {
        caps_.resize(part_.cells.size());
        return std::move(caps_);
    }

private:
    /// The boundary of a cap of the whole hull.
    struct OfHull {
        int sign = 0;
        Array<std::uint64_t> vertices; ///< of the hull, ascending
        Array<Facet<D>> facets;        ///< in numbers of `vertices`
        Array<Point<D>> points;        ///< of `vertices`; on the rank that proves
    };
    using FacetInHull = std::array<std::uint64_t, D>;
    using Corners = std::array<Point<D>, D>;

    int prover(std::size_t cap) const { return cap == 0 ? 0 : ranks_.size() - 1; }

    OfHull gather(CapOf cap) const {
        const CellsInCaps<D> here{part_.points, part_.cells, part_.neighbors, caps_};
        OfHull whole;
        CapSigns signs;
        for (const CapSigns& each : ranks_.gather(signs_of_cap<D>(here, cap))) {
            signs.add(each);
        }
        whole.sign = signs.common();
        const Array<Facet<D>> own = outer_facets<D>(here, cap);
        const Array<FacetInHull> facets = joined(ranks_.all_gather<FacetInHull>(in_hull(own)));
        number(facets, whole);
        std::vector<Array<Corners>> to(static_cast<std::size_t>(ranks_.size()));
        to[static_cast<std::size_t>(prover(cap == CapOf::first ? 0 : 1))] = corners(own);
        const Array<Corners> corners_there = joined(ranks_.all_to_all(to));
        whole.points.resize(whole.vertices.size());
        for (std::size_t f = 0; f < corners_there.size(); ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                whole.points[whole.facets[f][i]] = corners_there[f][i];
            }
        }
        return whole;
    }

    Array<FacetInHull> in_hull(const Array<Facet<D>>& facets) const {
        Array<FacetInHull> result(facets.size());
        for (std::size_t f = 0; f < facets.size(); ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                result[f][i] = part_.points_used->member(facets[f][i]);
            }
        }
        return result;
    }

    Array<Corners> corners(const Array<Facet<D>>& facets) const {
        Array<Corners> result(facets.size());
        for (std::size_t f = 0; f < facets.size(); ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                std::copy_n(part_.points[facets[f][i]].begin(), D, result[f][i].begin());
            }
        }
        return result;
    }

    static void number(const Array<FacetInHull>& facets, OfHull& whole) {
        for (const FacetInHull& facet : facets) {
            whole.vertices.insert(whole.vertices.end(), facet.begin(), facet.end());
        }
        sort_out(whole.vertices);
        whole.facets.resize(facets.size());
        for (std::size_t f = 0; f < facets.size(); ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                const auto place =
                    std::lower_bound(whole.vertices.begin(), whole.vertices.end(), facets[f][i]);
                whole.facets[f][i] = static_cast<Index>(place - whole.vertices.begin());
            }
        }
    }

    bool keeps_to(const OfHull& boundary, double time) const {
        Array<Index> on_boundary;
        on_boundary.assign(part_.points.size(), no_index);
        for (std::size_t k = 0; k < boundary.vertices.size(); ++k) {
            if (part_.points_used->contains(boundary.vertices[k])) {
                on_boundary[part_.points_used->rank(boundary.vertices[k])] = static_cast<Index>(k);
            }
        }
        return side_keeps_to<D>({part_.points, part_.cells, part_.neighbors, caps_}, time, on_boundary,
                                edges_of<D>(boundary.facets));
    }

    const HullPart<D>& part_;
    Communicator& ranks_;
    std::array<double, 2> times_;
    Array<CapOf> caps_; ///< of the part's cells, then of those outside
};

template<int D>
class PartSearch {
public:
    PartSearch(const HullPart<D>& part, Communicator& ranks, std::size_t limit)
        : part_{part}, ranks_{ranks}, limit_{limit} {}

    PartsEmbedding<D> run() {
        PartsEmbedding<D> result;
        Array<CapOf> caps = unproven_to_none(result.all);
        CellGroups<D> groups{part_.cells, caps};
        const GhostsOfSearch<D> ghosts = SearchAssembly<D>{part_, ranks_, caps, groups}.run();
        Array<CapOf>{}.swap(caps); // the search takes much memory
        const Array<Index> outside = ghosts.numbers.outside();
        const PartialMesh<D> mesh{part_.cells, part_.neighbors, outside, ghosts.cells, ghosts.neighbors, {}};
        const JoinedSpans<Point<D + 1>> points{part_.points, ghosts.points};
        groups.add_ghosts(mesh, points.size(), ghosts.sizes, ghosts.touching);
        const auto is_complete = [&](Index v) {
            return v < ghosts.complete.size() && ghosts.complete[v] != 0;
        };
        const HullEmbedding<D> own =
            search_crossings<D>({points, mesh, groups, [](std::span<const Index>) {}, is_complete,
                                 [&](Array<StarState>& stars) { complete_stars_of(stars); }},
                                limit_);
        reduce(own, mesh, points, ghosts.numbers, result);
        return result;
    }

private:
    /// The cap of each cell, if both are proven to be embedded; else all cells are taken for the side's, so
    /// that they are tested.
    Array<CapOf> unproven_to_none(HullEmbedding<D>& all) const {
        CapsOfParts<D> proof{part_, ranks_};
        all.caps_proven = proof.are_embedded();
        Array<CapOf> caps = proof.take_caps();
        if (!all.caps_proven) {
            std::fill(caps.begin(), caps.end(), CapOf::none);
        }
        all.tested_cells =
            ranks_.sum(static_cast<std::size_t>(std::count(caps.begin(), caps.end(), CapOf::none)));
        return caps;
    }

    /// Tells the other ranks at a vertex that its star is proven.
    void complete_stars_of(Array<StarState>& stars) const {
        Array<std::uint8_t> open(part_.points.size());
        for (std::size_t v = 0; v < open.size(); ++v) {
            open[v] = stars[v] == StarState::proven ? 0 : 1;
        }
        open = lowest_at_points<std::uint8_t>(part_, ranks_, open);
        for (std::size_t v = 0; v < open.size(); ++v) {
            stars[v] = open[v] == 0 ? StarState::proven : stars[v];
        }
    }

    void reduce(const HullEmbedding<D>& own, const PartialMesh<D>& mesh,
                const JoinedSpans<Point<D + 1>>& points, const GhostNumbering<D>& numbers,
                PartsEmbedding<D>& result) const {
        HullEmbedding<D>& all = result.all;
        all.all_listed = ranks_.min(own.all_listed ? 1 : 0) == 1;
        all.stars = ranks_.sum(own.stars);
        all.proven_stars = ranks_.sum(own.proven_stars);
        all.group_pairs = ranks_.sum(own.group_pairs);
        all.tested_pairs = ranks_.sum(own.tested_pairs);
        all.exact_pairs = ranks_.sum(own.exact_pairs);
        std::vector<CrossingInHull<D>> mine;
        for (const Crossing<D + 1>& crossing : own.crossings) {
            if (crossing.first != crossing.second) {
                mine.push_back(in_hull(crossing, mesh, points, numbers));
            }
        }
        const auto found = joined(ranks_.all_gather<CrossingInHull<D>>(mine));
        result.crossings.assign(found.begin(), found.end());
        std::sort(result.crossings.begin(), result.crossings.end(), [](const auto& a, const auto& b) {
            return std::tie(a.cells.first, a.cells.second) < std::tie(b.cells.first, b.cells.second);
        });
        if (result.crossings.size() > limit_) {
            result.crossings.resize(limit_);
            all.all_listed = false;
        }
    }

    static CrossingInHull<D> in_hull(const Crossing<D + 1>& crossing, const PartialMesh<D>& mesh,
                                     const JoinedSpans<Point<D + 1>>& points,
                                     const GhostNumbering<D>& numbers) {
        CrossingInHull<D> result{crossing, {}};
        std::array<std::pair<std::uint64_t, std::array<double, 2>>, 2> cells;
        for (std::size_t k = 0; k < 2; ++k) {
            const Index cell = k == 0 ? crossing.first : crossing.second;
            cells[k] = {numbers.in_hull(cell), time_span<D>(points, {&mesh.cell(cell), 1})};
        }
        std::sort(cells.begin(), cells.end());
        result.cells.first = static_cast<Index>(cells[0].first);
        result.cells.second = static_cast<Index>(cells[1].first);
        result.times = {cells[0].second, cells[1].second};
        return result;
    }

    const HullPart<D>& part_;
    Communicator& ranks_;
    std::size_t limit_;
};

} // namespace

template<int D>
PartsEmbedding<D> examine_parts(const HullPart<D>& part, Communicator& ranks, std::size_t limit) {
    return together(ranks, [&] { return PartSearch<D>{part, ranks, limit}.run(); });
}

template PartsEmbedding<2> examine_parts<2>(const HullPart<2>&, Communicator&, std::size_t);
template PartsEmbedding<3> examine_parts<3>(const HullPart<3>&, Communicator&, std::size_t);

} // namespace slabhull
