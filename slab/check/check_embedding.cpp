// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check_embedding.h"

#include "slab/check/findings.h"

#include "slabhull/core/progress.h"
#include "slabhull/geometry/hull_embedding.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

namespace slabhull {

namespace {

/// Most crossings that are searched for: a body that moves through another has thousands.
constexpr std::size_t most_crossings = 300;

template<int D>
class CrossingNames {
public:
    CrossingNames(const HullColumns<D>& hull, const Findings& findings) : hull_{hull}, findings_{findings} {}

    std::string text(const Crossing<D + 1>& crossing) const {
        const auto& at = crossing.near;
        return fmt::format("{} and {} meet at t = {:.6g} near ({:.6g})", name(crossing.first),
                           name(crossing.second), at[D], fmt::join(at.begin(), at.begin() + D, ", "));
    }

private:
    /// "cell 812 (patch rotor, t = 0.25 to 0.5)"
    std::string name(Index cell) const {
        double first = hull_.points[hull_.cells[cell][0]][D];
        double last = first;
        for (const Index v : hull_.cells[cell]) {
            first = std::min(first, hull_.points[v][D]);
            last = std::max(last, hull_.points[v][D]);
        }
        const std::string times = first == last ? fmt::format("t = {:.6g}", first)
                                                : fmt::format("t = {:.6g} to {:.6g}", first, last);
        return fmt::format("cell {} ({}{})", findings_.cell_entities({&cell, 1}).front().number, patch(cell),
                           times);
    }

    std::string patch(Index cell) const {
        std::int64_t number = 0;
        if (hull_.patch.given() && hull_.patch.rows() == hull_.cells.size()) {
            hull_.patch.fill(cell, cell + 1, &number);
        }
        if (number <= 0) {
            return {};
        }
        const std::string name = patch_name(hull_.patches, static_cast<PatchNumber>(number));
        return name.starts_with("patch ") ? name + ", " : "patch " + name + ", ";
    }

    const HullColumns<D>& hull_;
    const Findings& findings_;
};

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
    const CrossingNames<D> names{hull, findings};
    for (const Crossing<D + 1>& crossing : found.crossings) {
        if (crossing.first != crossing.second) {
            const std::array<Index, 2> both{crossing.first, crossing.second};
            findings.other(Defect::self_crossing, findings.cell_entities(both), names.text(crossing));
        }
    }
    return EmbeddingSummary{findings.count(Defect::self_crossing),
                            found.all_listed,
                            found.caps_proven,
                            found.tested_cells,
                            found.stars,
                            found.proven_stars,
                            found.group_pairs,
                            found.tested_pairs,
                            found.exact_pairs};
}

template std::optional<EmbeddingSummary> check_embedding<2>(const HullColumns<2>&, const CheckOptions&,
                                                            HullReport&, bool);
template std::optional<EmbeddingSummary> check_embedding<3>(const HullColumns<3>&, const CheckOptions&,
                                                            HullReport&, bool);

} // namespace slabhull
