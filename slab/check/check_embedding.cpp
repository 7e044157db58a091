// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check_embedding.h"

#include "core/place_in_words.h"
#include "geometry/embedding/embedded_caps.h"
#include "slab/check/findings.h"
#include "slab/check/part_embedding.h"

#include "slabhull/core/progress.h"
#include "slabhull/geometry/hull_embedding.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace slabhull {

namespace {

/// Most crossings that are searched for: a body that moves through another has thousands.
constexpr std::size_t most_crossings = 300;

/// One of two cells that cross, as a message names it.
struct NamedCell {
    std::int64_t number; ///< the user's
    std::string patch;   ///< empty: none
    std::array<double, 2> times;
};

/// "cell 812 (patch rotor, t = 0.25 to 0.5)"
std::string text_of(const NamedCell& cell) {
    const auto [first, last] = cell.times;
    const std::string times =
        first == last ? fmt::format("t = {:.9g}", first) : fmt::format("t = {:.9g} to {:.9g}", first, last);
    const std::string patch = cell.patch.empty()                 ? ""
                              : cell.patch.starts_with("patch ") ? cell.patch + ", "
                                                                 : "patch " + cell.patch + ", ";
    return fmt::format("cell {} ({}{})", cell.number, patch, times);
}

/// Adds crossings to the findings. `patch_of` gives the number of a cell's patch; none if it is not positive.
template<int D>
class CrossingNames {
public:
    CrossingNames(Findings& findings, const PatchList& patches,
                  std::function<std::int64_t(Index cell)> patch_of)
        : findings_{findings}, patches_{patches}, patch_of_{std::move(patch_of)} {}

    void add(const Crossing<D + 1>& crossing, const std::array<std::array<double, 2>, 2>& times) {
        const std::array<Index, 2> both{crossing.first, crossing.second};
        const auto& at = crossing.near;
        findings_.other(Defect::self_crossing, findings_.cell_entities(both),
                        fmt::format("{} and {} meet at t = {:.9g} near {}", text_of(named(both[0], times[0])),
                                    text_of(named(both[1], times[1])), at[D],
                                    place_in_words(std::span{at}.template first<D>())));
    }

private:
    NamedCell named(Index cell, const std::array<double, 2>& times) const {
        const std::int64_t patch = patch_of_(cell);
        return {findings_.cell_entities({&cell, 1}).front().number,
                patch > 0 ? patch_name(patches_, static_cast<PatchNumber>(patch)) : "", times};
    }

    Findings& findings_;
    const PatchList& patches_;
    std::function<std::int64_t(Index cell)> patch_of_;
};

/// The patch of a cell, 0 where the hull has none or too many.
template<int D>
std::int64_t claimed_patch(const HullColumns<D>& hull, Index cell) {
    std::int64_t number = 0;
    if (hull.patch.given() && hull.patch.rows() == hull.cells.size()) {
        hull.patch.fill(cell, cell + 1, &number);
    }
    return number;
}

template<int D>
EmbeddingSummary summary_of(const Findings& findings, const HullEmbedding<D>& found) {
    return {findings.count(Defect::self_crossing),
            found.all_listed,
            found.caps_proven,
            found.tested_cells,
            found.stars,
            found.proven_stars,
            found.group_pairs,
            found.tested_pairs,
            found.exact_pairs};
}

template<int D>
HullEmbedding<D> examine(const HullColumns<D>& hull, bool table_confirmed) {
    if (table_confirmed) {
        return examine_embedding<D>(hull.points, hull.cells, AdjacencyView<D>{hull.neighbor_table},
                                    most_crossings);
    }
    const Adjacency<D> adjacency = build_adjacency<D>(hull.cells, hull.points.size());
    return examine_embedding<D>(hull.points, hull.cells, adjacency, most_crossings);
}

} // namespace

template<int D>
std::optional<EmbeddingSummary> check_embedding(const HullColumns<D>& hull, const CheckOptions& options,
                                                HullReport& report, bool torn) {
    Findings findings{report, options};
    if (findings.any({Defect::no_cells, Defect::index_out_of_range, Defect::non_finite_coordinate})) {
        findings.skip("embedding",
                      "there are no cells, or cells and coordinates that geometry does not apply to");
        return {};
    }
    if (!torn && findings.any({Defect::repeated_vertex, Defect::duplicate_cell, Defect::open_facet,
                               Defect::overfull_facet, Defect::disoriented_facet})) {
        findings.skip("embedding", "there are facets at fault, so that cells would have to be tested in "
                                   "pairs, which was not asked for");
        return {};
    }
    enter_stage("embedding");
    const HullEmbedding<D> found = examine(hull, report.table_confirmed);
    CrossingNames<D> names{findings, hull.patches, [&](Index cell) { return claimed_patch(hull, cell); }};
    for (const Crossing<D + 1>& crossing : found.crossings) {
        if (crossing.first != crossing.second) {
            names.add(crossing, {time_span<D>(hull.points, {&hull.cells[crossing.first], 1}),
                                 time_span<D>(hull.points, {&hull.cells[crossing.second], 1})});
        }
    }
    return summary_of(findings, found);
}

template<int D>
EmbeddingSummary check_embedding_of_parts(const HullPart<D>& part, const HullOrder<D>& order,
                                          Communicator& ranks, const CheckOptions& options,
                                          HullReport& report) {
    enter_stage("embedding");
    const PartsEmbedding<D> found = examine_parts(part, ranks, most_crossings);
    Findings findings{report, options};
    CrossingNames<D> names{findings, order.patches, [&](Index cell) { return order.patch(cell); }};
    for (const CrossingInHull<D>& crossing : found.crossings) {
        names.add(crossing.cells, crossing.times);
    }
    return summary_of(findings, found.all);
}

template std::optional<EmbeddingSummary> check_embedding<2>(const HullColumns<2>&, const CheckOptions&,
                                                            HullReport&, bool);
template std::optional<EmbeddingSummary> check_embedding<3>(const HullColumns<3>&, const CheckOptions&,
                                                            HullReport&, bool);
template EmbeddingSummary check_embedding_of_parts<2>(const HullPart<2>&, const HullOrder<2>&, Communicator&,
                                                      const CheckOptions&, HullReport&);
template EmbeddingSummary check_embedding_of_parts<3>(const HullPart<3>&, const HullOrder<3>&, Communicator&,
                                                      const CheckOptions&, HullReport&);

} // namespace slabhull
