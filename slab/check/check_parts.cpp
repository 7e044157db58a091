// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check_parts.h"

#include "core/hash.h"
#include "core/pieces.h"
#include "slab/check/cell_survey.h"
#include "slab/check/check_shape.h"
#include "slab/check/hull_view.h"
#include "slab/check/may_repeat.h"
#include "slab/check/part_exchange.h"
#include "slab/check/part_stars.h"
#include "slabhull/core/index.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/progress.h"
#include "slabhull/topology/partial_stars.h"
#include "topology/complex/union_find.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <utility>

namespace slabhull {

namespace {

template<int D>
class PartCheck {
public:
    PartCheck(const HullPart<D>& part, const HullColumns<D>& claims, Communicator& ranks, HullReport& report)
        : part_{part}, ranks_{ranks}, report_{report}, findings_{found_, options_},
          view_{claims, AdjacencyView<D>{part.neighbors}, {}, {}, {}} {
        view_.hull.points = part.points;
        view_.hull.cells = part.cells;
        view_.outside = part.outside.size();
        view_.track = part.track_ids;
    }

    /// Whether nothing is wrong, the same on all ranks; then the report is complete.
    bool run() {
        report_.dimension = D;
        report_.table_confirmed = true;
        enter_stage("checking", part_.points.size());
        give_back_freed_memory(); // memory used to build the hull
        if (!all(check_finite<D + 1>(part_.points, findings_)) || !find_times() || !find_regions()) {
            return false;
        }
        const PartStars<D> stars = complete_stars(part_, view_, ranks_);
        return confirm_connectivity(stars) && points_differ(stars) && ids_differ(stars) &&
               measures_are_sound() && claims_are_sound() && euler_is_sound(stars) &&
               tracks_are_sound(view_, stars, ranks_) &&
               (!view_.hull.patch.given() || patch_columns_agree(view_, ranks_));
    }

private:
    /// Whether something holds on every rank.
    bool all(bool here) const { return ranks_.min(here ? 1 : 0) == 1; }
    bool none_found() const { return all(found_.clean()); }

    // --- times and regions

    bool find_times() {
        double first = std::numeric_limits<double>::infinity();
        double last = -first;
        for (const Point<D + 1>& point : part_.points) {
            first = std::min(first, point[D]);
            last = std::max(last, point[D]);
        }
        view_.time = {ranks_.min(first), ranks_.max(last)};
        report_.time = view_.time;
        return view_.time[0] < view_.time[1] && view_.hull.time.value_or(view_.time) == view_.time;
    }

    bool find_regions() {
        const std::array<bool, 3> any = check_regions_of_part(view_, findings_);
        std::array<bool, 3> anywhere{};
        for (const std::array<bool, 3>& each : ranks_.gather(any)) {
            for (std::size_t r = 0; r < 3; ++r) {
                anywhere[r] = anywhere[r] || each[r];
            }
        }
        const auto outside =
            values_outside<Region>(part_, ranks_, [&](Index cell) { return view_.region[cell]; });
        for (std::size_t k = 0; k < outside.size(); ++k) {
            view_.region.set(part_.cells.size() + k, outside[k]);
        }
        return none_found() && anywhere[0] && anywhere[2];
    }

    // --- connectivity

    bool confirm_connectivity(const PartStars<D>& stars) {
        const auto counted = confirm_stars<D>(stars.mesh_with(part_));
        const StarCounts here = counted.value_or(StarCounts{});
        ManifoldCounts& counts = report_.counts;
        counts =
            closed_counts<D>(part_.hull_cells, {ranks_.sum(here.vertices), ranks_.sum(here.link_vertices)});
        if (!all(counted.has_value() && counts.vertices == part_.hull_points())) {
            return false;
        }
        counts.components = components();
        return true;
    }

    /// Components of the parts, joined across the facets between them. Those by shared vertices are those by
    /// shared facets, since every star is joined through facets; vertices are fewer than cells.
    std::size_t components() const {
        UnionFind joined = joined_vertices<D + 1>(part_.cells, part_.points.size());
        const auto label_of_point = [&](Index v) {
            return static_cast<std::uint64_t>(ranks_.rank()) << 32 | joined.find(v);
        };
        const auto label = [&](Index cell) { return label_of_point(part_.cells[cell][0]); };
        const Array<std::uint64_t> beside = values_outside<std::uint64_t>(part_, ranks_, label);
        using Link = std::array<std::uint64_t, 2>; // of two components; of one with itself, that it is there
        std::vector<Link> links;
        for (std::size_t v = 0; v < part_.points.size(); ++v) {
            if (joined.is_root(static_cast<Index>(v))) {
                links.push_back(
                    {label_of_point(static_cast<Index>(v)), label_of_point(static_cast<Index>(v))});
            }
        }
        const auto cells = static_cast<Index>(part_.cells.size());
        for (Index c = 0; c < cells; ++c) {
            for (const Index neighbor : part_.neighbors[c]) {
                if (neighbor >= cells) {
                    links.push_back({label(c), beside[neighbor - cells]});
                }
            }
        }
        sort_out(links);
        return count_joined(slabhull::joined(ranks_.all_gather<Link>(links)));
    }

    static std::size_t count_joined(const Array<std::array<std::uint64_t, 2>>& links) {
        std::vector<std::uint64_t> labels;
        for (const auto& link : links) {
            labels.push_back(link[0]);
        }
        sort_out(labels);
        UnionFind joined{labels.size()};
        const auto place = [&](std::uint64_t label) {
            return static_cast<Index>(std::lower_bound(labels.begin(), labels.end(), label) - labels.begin());
        };
        for (const auto& link : links) {
            joined.join(place(link[0]), place(link[1]));
        }
        return joined.count_sets();
    }

    // --- points and ids: what may be equal meets on one rank

    /// Brings a value of each owned point to the rank that its hash says, and all that come to this one.
    template<class T, class Hash, class ValueOf>
    Array<T> brought_together(const PartStars<D>& stars, const Hash& hash, const ValueOf& value_of) const {
        std::vector<Array<T>> to(static_cast<std::size_t>(ranks_.size()));
        for (Array<T>& each : to) {
            each.reserve(part_.points.size() / to.size());
        }
        for (std::size_t v = 0; v < part_.points.size(); ++v) {
            if (stars.owned[v] != 0) {
                to[hash(v) % to.size()].push_back(value_of(v));
            }
        }
        return joined(ranks_.all_to_all(to));
    }

    /// Whether values are all different, on all ranks. `hash_of` gives their hashes.
    template<class T, class HashOf>
    bool all_differ(const Array<T>& values, const HashOf& hash_of) const {
        std::vector<T> candidates;
        for (const Index k :
             may_repeat(values.size(), [&](std::size_t each) { return hash_of(values[each]); })) {
            candidates.push_back(values[k]);
        }
        std::sort(candidates.begin(), candidates.end());
        return all(std::adjacent_find(candidates.begin(), candidates.end()) == candidates.end());
    }

    /// Points whose hashes differ do; only if some are equal, the points themselves are compared.
    bool points_differ(const PartStars<D>& stars) {
        const auto hash = [&](std::size_t v) { return fingerprint(part_.points[v]); };
        if (all_differ(brought_together<std::uint64_t>(stars, hash, hash), std::identity{})) {
            return true;
        }
        const auto point = [&](std::size_t v) { return part_.points[v]; };
        const auto here = brought_together<Point<D + 1>>(stars, hash, point);
        check_coincident<D + 1>(here, findings_);
        return none_found();
    }

    bool ids_differ(const PartStars<D>& stars) const {
        const auto hash_of = [](std::int64_t id) { return combined_hash(0, static_cast<std::uint64_t>(id)); };
        const auto id = [&](std::size_t v) { return part_.vertex_ids[v]; };
        const auto hash = [&](std::size_t v) { return hash_of(part_.vertex_ids[v]); };
        const Array<std::int64_t> here = brought_together<std::int64_t>(stars, hash, id);
        const bool sound = std::all_of(here.begin(), here.end(), [](std::int64_t each) { return each >= 0; });
        return all(sound) && all_differ(here, hash_of);
    }

    // --- measures

    struct SurveyedCell {
        std::array<Point<D + 1>, D + 1> corners;
        Region region;
    };

    /// The first point of the hull, which is the origin of sums.
    Point<D + 1> origin() const {
        const bool here = part_.points_used->contains(0);
        const std::vector<Point<D + 1>> points = ranks_.gather(here ? part_.points[0] : Point<D + 1>{});
        const std::vector<char> have = ranks_.gather(static_cast<char>(here ? 1 : 0));
        return points[static_cast<std::size_t>(std::find(have.begin(), have.end(), 1) - have.begin())];
    }

    SurveyedCell surveyed(std::size_t c) const {
        return {corners_of<D, D + 1>(part_.cells[c], part_.points), view_.region_of(c)};
    }

    /// The end of the part's cells that belong to a piece of the sums which begins on an earlier rank.
    std::size_t end_of_head() const {
        const std::size_t into = part_.range.first % cells_per_survey;
        return into == 0 ? 0 : std::min(part_.range.count, cells_per_survey - into);
    }

    /// The cells that follow this rank's in its last piece of the sums, from the ranks after it.
    Array<SurveyedCell> receive_tail() const {
        const std::vector<std::size_t> first = ranks_.gather(part_.range.first);
        std::vector<Array<SurveyedCell>> to(first.size());
        const std::size_t head = end_of_head();
        if (head > 0) {
            const std::size_t begin = part_.range.first / cells_per_survey * cells_per_survey;
            const auto after = std::upper_bound(first.begin(), first.end(), begin);
            Array<SurveyedCell>& there = to[static_cast<std::size_t>(after - first.begin()) - 1];
            for (std::size_t c = 0; c < head; ++c) {
                there.push_back(surveyed(c));
            }
        }
        return joined(ranks_.all_to_all(to));
    }

    bool measures_are_sound() {
        const Point<D + 1> from = origin();
        const Array<SurveyedCell> tail = receive_tail();
        const std::size_t head = end_of_head();
        const std::size_t count = part_.cells.size() - head + tail.size();
        std::atomic<bool> sound{true};
        const auto pieces = parallel_pieces<SumsByRegion<D>>(
            count, cells_per_survey, [&](std::size_t begin, std::size_t end, SumsByRegion<D>& sums) {
                for (std::size_t k = begin; k < end; ++k) {
                    const SurveyedCell cell = head + k < part_.cells.size()
                                                  ? surveyed(head + k)
                                                  : tail[head + k - part_.cells.size()];
                    const CellFaults faults = survey_cell<D>(cell.region, cell.corners, from, 1, sums);
                    if (faults.degenerate || faults.inverted) {
                        sound = false;
                    }
                }
            });
        SumsByRegion<D> total;
        for (const SumsByRegion<D>& piece : joined(ranks_.all_gather<SumsByRegion<D>>(pieces))) {
            for (std::size_t r = 0; r < 3; ++r) {
                total[r].add(piece[r]);
            }
        }
        add_measures<D>({total[0].value(), total[1].value(), total[2].value()}, report_);
        return all(sound && report_.closure <= closure_tolerance * report_.measure && report_.enclosed > 0);
    }

    // --- claims

    bool claims_are_sound() {
        if (view_.hull.patch.given()) {
            count_patches(check_patches(view_, findings_));
        }
        if (view_.hull.layer.given()) {
            report_.layers = check_layers(view_, findings_, [this](Layers& all) { complete_layers(all); });
        }
        return none_found();
    }

    void count_patches(const std::vector<PatchCount>& mine) {
        std::map<PatchNumber, std::size_t> cells;
        for (const PatchCount& patch : joined(ranks_.all_gather<PatchCount>(mine))) {
            cells[patch.number] += patch.cells;
        }
        for (const auto& [number, count] : cells) {
            report_.cells_by_patch.push_back({number, count});
        }
    }

    /// Adds the layers of the other parts.
    void complete_layers(Layers& layers) const {
        struct Count {
            std::int64_t layer;
            std::uint64_t end;
            double time;
            std::uint64_t cells;
        };
        std::vector<Count> mine;
        for (const auto& [layer, times] : layers) {
            for (std::size_t end = 0; end < 2; ++end) {
                for (const auto& [time, cells] : times[end]) {
                    mine.push_back({layer, end, time, cells});
                }
            }
        }
        layers.clear();
        for (const Count& count : joined(ranks_.all_gather<Count>(mine))) {
            layers[count.layer][count.end][count.time] += count.cells;
        }
    }

    /// Both caps have the same Euler characteristic, and a hull of dimension 2 twice that.
    bool euler_is_sound(const PartStars<D>& stars) const {
        if constexpr (D == 3) {
            return true; // see check_euler()
        }
        std::array<std::int64_t, 2> euler{};
        for (std::size_t cap = 0; cap < 2; ++cap) {
            const Region region = cap == 0 ? Region::initial : Region::terminating;
            CapCounts counts = counts_of_cap(stars, region);
            counts = {ranks_.sum(counts.vertices), ranks_.sum(counts.cells), ranks_.sum(counts.boundary)};
            euler[cap] = counts.euler();
        }
        return euler[0] == euler[1] && report_.counts.euler == 2 * euler[1];
    }

    CapCounts counts_of_cap(const PartStars<D>& stars, Region cap) const {
        CapCounts counts;
        std::vector<bool> used(stars.owned.size(), false);
        stars.each_cell(view_, [&](const Simplex<D>& cell, Region region) {
            for (const Index v : cell) {
                used[v] = used[v] || (region == cap && stars.owned[v] != 0);
            }
        });
        counts.vertices = std::count(used.begin(), used.end(), true);
        for (std::size_t c = 0; c < part_.cells.size(); ++c) {
            if (view_.region_of(c) == cap) {
                ++counts.cells;
                for (const Index neighbor : part_.neighbors[c]) {
                    counts.boundary += view_.region_of(neighbor) != cap ? 1 : 0;
                }
            }
        }
        return counts;
    }

    const HullPart<D>& part_;
    Communicator& ranks_;
    HullReport& report_;
    CheckOptions options_;
    CheckResult found_; ///< by this rank, in its own numbers: only whether there is anything counts
    Findings findings_;
    HullView<D> view_;
};

/// The lists that the ranks have, one after the other, on the first of them.
template<class T>
Array<T> gather_on_first(std::span<const T> mine, Communicator& ranks) {
    std::vector<Array<T>> to(static_cast<std::size_t>(ranks.size()));
    to[0].assign(mine.begin(), mine.end());
    return joined(ranks.all_to_all(to));
}

/// Rows of a part with the numbers of the hull.
template<class Row, class Number>
Array<Row> renumbered_rows(const Array<Row>& rows, const Number& number) {
    Array<Row> result = rows;
    for (Row& row : result) {
        for (Index& entry : row) {
            entry = static_cast<Index>(number(entry));
        }
    }
    return result;
}

} // namespace

template<int D>
Hull<D> gather_hull(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks) {
    checked_index(part.hull_cells, "hull cells");
    checked_index(part.hull_points(), "hull vertices");
    Array<std::uint64_t> numbers(part.points.size());
    each_point_of(part, [&](std::size_t k, std::size_t number) { numbers[k] = number; });
    Hull<D> hull;
    static_cast<HullOrder<D>&>(hull) = order;
    hull.cells =
        gather_on_first<Simplex<D>>(renumbered_rows(part.cells, [&](Index v) { return numbers[v]; }), ranks);
    hull.neighbors = gather_on_first<Neighbors<D>>(
        renumbered_rows(part.neighbors, [&](Index n) { return part.in_hull(n); }), ranks);
    Array<std::int64_t> ids(part.points.size());
    Array<std::int64_t> tracks(part.points.size());
    part.vertex_ids.copy(0, ids.size(), ids.data());
    part.track_ids.copy(0, tracks.size(), tracks.data());
    numbers = gather_on_first<std::uint64_t>(numbers, ranks);
    const Array<Point<D + 1>> points = gather_on_first<Point<D + 1>>(part.points, ranks);
    ids = gather_on_first<std::int64_t>(ids, ranks);
    tracks = gather_on_first<std::int64_t>(tracks, ranks);
    if (ranks.first()) {
        hull.points.resize(part.hull_points());
        Array<std::int64_t> all_ids(hull.points.size());
        Array<std::int64_t> all_tracks(hull.points.size());
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            hull.points[numbers[k]] = points[k];
            all_ids[numbers[k]] = ids[k];
            all_tracks[numbers[k]] = tracks[k];
        }
        hull.vertex_ids.append(all_ids);
        hull.track_ids.append(all_tracks);
    }
    return hull;
}

template<int D>
std::optional<HullReport> confirm_parts(const HullPart<D>& part, const HullColumns<D>& claims,
                                        Communicator& ranks) {
    HullReport report;
    return PartCheck<D>{part, claims, ranks, report}.run() ? std::optional{std::move(report)} : std::nullopt;
}

template<int D>
HullReport check_parts(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks,
                       const CheckOptions& options) {
    HullColumns<D> claims;
    claims.region = region_column(order, part.range);
    claims.patch = patch_column(order, part.range);
    claims.layer = layer_column(order, part.range);
    claims.patches = order.patches;
    claims.time = order.time;
    if (auto sound = confirm_parts(part, claims, ranks)) {
        return *std::move(sound);
    }
    const Hull<D> hull = gather_hull(part, order, ranks);
    HullReport report =
        together(ranks, [&] { return ranks.first() ? check_hull<D>(hull, options) : HullReport{}; });
    report.found = ranks.gather(report.found).front();
    return report;
}

template std::optional<HullReport> confirm_parts<2>(const HullPart<2>&, const HullColumns<2>&, Communicator&);
template std::optional<HullReport> confirm_parts<3>(const HullPart<3>&, const HullColumns<3>&, Communicator&);
template Hull<2> gather_hull<2>(const HullPart<2>&, const HullOrder<2>&, Communicator&);
template Hull<3> gather_hull<3>(const HullPart<3>&, const HullOrder<3>&, Communicator&);
template HullReport check_parts<2>(const HullPart<2>&, const HullOrder<2>&, Communicator&,
                                   const CheckOptions&);
template HullReport check_parts<3>(const HullPart<3>&, const HullOrder<3>&, Communicator&,
                                   const CheckOptions&);

} // namespace slabhull
