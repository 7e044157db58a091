// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/part_embedding.h"

#include "core/joined_spans.h"
#include "core/pieces.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/cell_groups.h"
#include "geometry/embedding/cell_pairs.h"
#include "geometry/embedding/embedded_caps.h"
#include "geometry/embedding/embedding_search.h"
#include "slab/check/ghost_cells.h"
#include "slab/check/part_exchange.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

constexpr std::int32_t no_rank = std::numeric_limits<std::int32_t>::max();

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

/// What one rank sends to another: groups of tested cells, in order, and cells that are not tested but touch
/// tested ones. `Cell`: GhostCell, or before that a cell's number in the part.
template<int D, class Cell>
struct CellsForRank {
    Array<std::uint8_t> sizes; ///< of the groups
    Array<Cell> tested;
    Array<Cell> touching;
    Array<std::uint64_t> points; ///< of the cells, in the hull
    Array<Point<D + 1>> places;  ///< of these points
};

/// The same from all ranks, each list in their order.
template<int D>
struct CellsFromRanks {
    std::vector<Array<std::uint8_t>> sizes;
    std::vector<Array<GhostCell<D>>> tested;
    std::vector<Array<GhostCell<D>>> touching;
    std::vector<Array<std::uint64_t>> points;
    std::vector<Array<Point<D + 1>>> places;
};

/// What one rank's search needs beside its part: the tested cells of later ranks that may meet its own, and
/// cells that are not tested but touch these.
template<int D>
struct GhostsOfSearch {
    GhostNumbering<D> numbers;
    Array<std::uint8_t> sizes;  ///< of the groups of tested ghosts, which come first
    Array<Point<D + 1>> points; ///< that are not the part's
    Array<Simplex<D>> cells;    ///< in the part's points, then `points`
    Array<Neighbors<D>> neighbors;
    PointSet touching; ///< the part's cells that are not tested, but complete a star of this rank's
    Array<std::uint8_t> complete; ///< of the part's points, whether it is this rank that proves their stars
};

/// Brings together the cells that each rank's search needs.
template<int D>
class SearchAssembly {
public:
    /// `groups`: of the part's cells.
    SearchAssembly(const HullPart<D>& part, Communicator& ranks, std::span<const CapOf> caps,
                   const CellGroups<D>& groups)
        : part_{part}, ranks_{ranks}, caps_{caps}, groups_{groups}, touching_{part.cells.size()},
          owners_{lowest_at_points<std::int32_t>(part, ranks, ranks_of_tested_points())} {}

    GhostsOfSearch<D> run() {
        CellsFromRanks<D> sent = exchange();
        GhostsOfSearch<D> ghosts{
            numbering(sent), joined(std::move(sent.sizes)), {}, {}, {}, std::move(touching_), owned()};
        list_ghosts(sent, ghosts);
        return ghosts;
    }

private:
    bool is_tested(std::size_t cell) const { return caps_[cell] == CapOf::none; }

    Array<std::int32_t> ranks_of_tested_points() const {
        Array<std::int32_t> result;
        result.assign(part_.points.size(), no_rank);
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            for (const Index v : part_.cells[c]) {
                result[v] = is_tested(c) ? ranks_.rank() : result[v];
            }
        }
        return result;
    }

    Array<std::uint8_t> owned() const {
        Array<std::uint8_t> result(owners_.size());
        std::transform(owners_.begin(), owners_.end(), result.begin(),
                       [&](std::int32_t owner) -> std::uint8_t { return owner == ranks_.rank() ? 1 : 0; });
        return result;
    }

    // --- what is sent

    Box<D + 1> group_box(std::size_t group) const {
        Box<D + 1> box;
        for (const Index v : groups_.vertices(group)) {
            box.include(part_.points[v]);
        }
        return box;
    }

    /// A box around all tested cells of each later rank that has some.
    Array<Box<D + 1>> boxes_of_later_ranks() const {
        Box<D + 1> own;
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            own.include(group_box(g));
        }
        Array<Box<D + 1>> later;
        const std::vector<Box<D + 1>> all = ranks_.gather(own);
        const std::vector<std::size_t> groups = ranks_.gather(groups_.own());
        for (auto r = static_cast<std::size_t>(ranks_.rank()) + 1; r < all.size(); ++r) {
            if (groups[r] > 0) {
                later.push_back(all[r]);
            }
        }
        return later;
    }

    /// Boxes around those of the part's tested cells that later ranks' may meet.
    Array<Box<D + 1>> boxes_for_later_ranks() const {
        constexpr std::size_t most = 1 << 13; // half a megabyte
        const Array<Box<D + 1>> later = boxes_of_later_ranks();
        Array<Box<D + 1>> boxes;
        if (later.empty()) {
            return boxes;
        }
        const BoxTree<D + 1> tree{later};
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            const Box<D + 1> box = group_box(g);
            bool meets = false;
            tree.find(box, [&](Index) { meets = true; });
            if (meets) {
                boxes.push_back(box);
            }
        }
        return boxes.size() <= most ? boxes : BoxTree<D + 1>{boxes}.at_most(most);
    }

    CellsFromRanks<D> exchange() {
        std::vector<CellsForRank<D, Index>> cells(static_cast<std::size_t>(ranks_.size()));
        list_groups_for_others(cells);
        list_touching_cells(cells);
        std::vector<CellsForRank<D, GhostCell<D>>> to(cells.size());
        for (std::size_t r = 0; r < cells.size(); ++r) {
            to[r] = for_rank(std::exchange(cells[r], {}));
        }
        CellsFromRanks<D> received;
        received.sizes = passed(to, &CellsForRank<D, GhostCell<D>>::sizes);
        received.tested = passed(to, &CellsForRank<D, GhostCell<D>>::tested);
        received.touching = passed(to, &CellsForRank<D, GhostCell<D>>::touching);
        received.points = passed(to, &CellsForRank<D, GhostCell<D>>::points);
        received.places = passed(to, &CellsForRank<D, GhostCell<D>>::places);
        return received;
    }

    /// Sends one of the lists to each rank and releases it.
    template<class T>
    std::vector<Array<T>> passed(std::vector<CellsForRank<D, GhostCell<D>>>& to,
                                 Array<T> CellsForRank<D, GhostCell<D>>::*list) const {
        std::vector<Array<T>> lists(to.size());
        for (std::size_t r = 0; r < to.size(); ++r) {
            lists[r] = std::move(to[r].*list);
        }
        return ranks_.all_to_all(lists);
    }

    /// Groups go to the earlier ranks near whose cells they are.
    void list_groups_for_others(std::vector<CellsForRank<D, Index>>& to) const {
        const auto near = ranks_.all_gather<Box<D + 1>>(boxes_for_later_ranks());
        Array<Box<D + 1>> earlier;
        std::vector<std::size_t> rank_of;
        for (std::size_t r = 0; r < static_cast<std::size_t>(ranks_.rank()); ++r) {
            earlier.insert(earlier.end(), near[r].begin(), near[r].end());
            rank_of.resize(earlier.size(), r);
        }
        if (earlier.empty()) {
            return;
        }
        const BoxTree<D + 1> tree{earlier};
        std::vector<std::size_t> targets;
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            targets.clear();
            tree.find(group_box(g), [&](Index box) { targets.push_back(rank_of[box]); });
            sort_out(targets);
            for (const std::size_t r : targets) {
                to[r].sizes.push_back(static_cast<std::uint8_t>(groups_.cell_count(g)));
                for (std::size_t k = 0; k < groups_.cell_count(g); ++k) {
                    to[r].tested.push_back(static_cast<Index>(groups_.first_cell(g) + k));
                }
            }
        }
    }

    /// Cells that are not tested go to the owners of their vertices, which prove the stars.
    void list_touching_cells(std::vector<CellsForRank<D, Index>>& to) {
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            if (is_tested(c)) {
                continue;
            }
            each_owner<D>(part_.cells[c], owners_, [&](std::int32_t owner) {
                if (owner == ranks_.rank()) {
                    touching_.insert(c);
                } else if (owner != no_rank) {
                    to[static_cast<std::size_t>(owner)].touching.push_back(static_cast<Index>(c));
                }
            });
        }
        touching_.count();
    }

    CellsForRank<D, GhostCell<D>> for_rank(CellsForRank<D, Index> cells) const {
        CellsForRank<D, GhostCell<D>> sent{std::move(cells.sizes), {}, {}, {}, {}};
        if (cells.tested.empty() && cells.touching.empty()) {
            return sent;
        }
        PointSet points{part_.points.size()};
        insert_points_of<D>(part_, cells.tested, points);
        insert_points_of<D>(part_, cells.touching, points);
        points.count();
        sent.points = numbers_of(part_, points);
        each_point_in(points.words(),
                      [&](std::size_t, std::size_t v) { sent.places.push_back(part_.points[v]); });
        sent.tested = ghost_cells<D>(part_, cells.tested, points);
        sent.touching = ghost_cells<D>(part_, cells.touching, points);
        return sent;
    }

    // --- what is here

    GhostNumbering<D> numbering(const CellsFromRanks<D>& sent) const {
        GhostNumbering<D> numbers{part_, joined(sent.points), numbers_of_ghosts(sent.tested),
                                  numbers_of_ghosts(sent.touching)};
        checked_index(numbers.cell_count(), "cells of a part");
        return numbers;
    }

    void list_ghosts(const CellsFromRanks<D>& sent, GhostsOfSearch<D>& ghosts) const {
        const GhostNumbering<D>& numbers = ghosts.numbers;
        ghosts.points.resize(numbers.point_count() - part_.points.size());
        ghosts.cells.reserve(numbers.cell_count() - part_.cells.size());
        ghosts.neighbors.reserve(numbers.cell_count() - part_.cells.size());
        std::vector<Array<Index>> points;
        for (std::size_t r = 0; r < sent.points.size(); ++r) {
            points.push_back(numbers.points(sent.points[r]));
            for (std::size_t k = 0; k < points[r].size(); ++k) {
                if (points[r][k] >= part_.points.size()) {
                    ghosts.points[points[r][k] - part_.points.size()] = sent.places[r][k];
                }
            }
        }
        for (const auto* lists : {&sent.tested, &sent.touching}) {
            for (std::size_t r = 0; r < lists->size(); ++r) {
                for (const GhostCell<D>& ghost : (*lists)[r]) {
                    numbers.append(ghost, points[r], ghosts.cells, ghosts.neighbors);
                }
            }
        }
    }

    const HullPart<D>& part_;
    Communicator& ranks_;
    std::span<const CapOf> caps_; ///< of the cells of the part; those in none are tested
    const CellGroups<D>& groups_;
    PointSet touching_;
    Array<std::int32_t>
        owners_; ///< the lowest rank that has a tested cell at each point; no_rank where none has
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
