// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check.h"

#include "slab/check/boundary_changes.h"
#include "slab/check/check_shape.h"
#include "slab/check/hull_view.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/vector.h"
#include "slabhull/slab/hull_columns.h"
#include "slabhull/topology/homology.h"

#include <fmt/format.h>

#include <cmath>

namespace slabhull {

namespace {

/// Runs the checks in order; each may need results of those before it.
template<int D>
class HullCheck {
public:
    HullCheck(const HullColumns<D>& hull, const CheckOptions& options)
        : options_{options}, findings_{report_, options_}, view_{hull, {}, {}, {}, {}} {}

    HullReport run() {
        report_.dimension = D;
        enter_stage("checking", view_.points().size() + view_.cells().size()); // stars, then cells
        give_back_freed_memory(); // memory used to build the hull
        check_column_lengths(view_.hull, findings_);
        if (!check_indices<D>(view_.cells(), view_.points().size(), findings_)) {
            findings_.skip("all but the indices",
                           "there are no cells, or cells name vertices that do not exist");
            return std::move(report_);
        }
        if (view_.hull.track_id.given()) {
            view_.track = read_ids(view_.hull.track_id);
        }
        const bool finite = check_finite<D + 1>(view_.points(), findings_);
        examine_connectivity();
        compare_numbering();
        if (finite) {
            examine_shape();
        } else {
            findings_.skip("shape, regions, tracks", "there are coordinates that are not finite");
        }
        return std::move(report_);
    }

private:
    void examine_connectivity() {
        const ManifoldReport manifold = manifold_report();
        translate(manifold, {}, findings_);
        report_.counts = manifold.counts;
        manifold_ = manifold.clean();
        sealed_ = view_.adjacency.defects.empty();
        if (options_.betti_cells > 0) {
            examine_homology();
        }
    }

    /// Uses the given table of neighbours if it proves right, else builds one.
    ManifoldReport manifold_report() {
        const std::size_t vertices = view_.points().size();
        const std::span<const Neighbors<D>> table = view_.hull.neighbor_table;
        if (auto report = confirm_manifold<D>(view_.cells(), vertices, table)) {
            confirmed_ = true;
            report_.table_confirmed = true;
            view_.adjacency = AdjacencyView<D>{table};
            return *std::move(report);
        }
        adjacency_ = build_adjacency<D>(view_.cells(), vertices);
        view_.adjacency = adjacency_;
        return examine_manifold<D>(view_.cells(), vertices, view_.adjacency, {options_.most_findings});
    }

    void examine_homology() {
        if (view_.cells().size() > options_.betti_cells) {
            findings_.skip("Betti numbers",
                           fmt::format("the hull has more than {} cells", options_.betti_cells));
        } else if (!manifold_) {
            findings_.skip("Betti numbers", "the hull is not a manifold");
        } else {
            const BettiNumbers<D> betti =
                betti_numbers<D>(view_.cells(), view_.points().size(), view_.adjacency.neighbors);
            report_.betti.assign(betti.begin(), betti.end());
        }
    }

    /// Compares the claims that need no geometry.
    void compare_numbering() {
        if (view_.hull.vertex_id.given()) {
            check_vertex_ids(view_, findings_);
        }
        if (view_.hull.neighbors.given() && !confirmed_) {
            check_neighbors(view_, findings_);
        }
        if (view_.hull.cell_of_vertex.given()) {
            check_cell_of_vertex(view_, findings_);
        }
    }

    void examine_shape() {
        check_coincident<D + 1>(view_.points(), findings_);
        const bool caps = check_regions(view_, findings_);
        report_.time = view_.time;
        if (view_.region.empty()) { // a hull without duration has no regions
            view_.region.reset(view_.cells().size());
        }
        const CellSurvey<D> survey = survey_cells(view_);
        report_degenerate<D, D + 1>(view_.points(), view_.cells(), survey.degenerate, findings_);
        add_measures<D>(survey.regions, report_);
        judge_measures();
        if (!caps || findings_.any({Defect::cap_not_flat, Defect::time_outside_slab})) {
            findings_.skip("caps, tracks, patches, layers", "the caps are not in place");
            return;
        }
        const bool inside_out = report_.enclosed < 0;
        report_inverted(view_, inside_out ? survey_cells(view_, -1).inverted : survey.inverted, findings_);
        examine_claims();
        examine_boundary();
    }

    void judge_measures() {
        if (!sealed_) {
            findings_.skip("closure, enclosed measure", "there are facets at fault");
            return;
        }
        if (!(report_.closure <= closure_tolerance * report_.measure)) {
            findings_.other(
                Defect::not_closed, {},
                fmt::format("the normals sum to a vector of length {:.3g}; the hull's measure is {:.6g}",
                            report_.closure, report_.measure));
        } else if (!(report_.enclosed > 0)) {
            findings_.other(
                Defect::inward_orientation, {},
                fmt::format("the hull encloses {:.6g}: its simplices face inwards", report_.enclosed));
        }
    }

    void examine_claims() {
        if (view_.hull.patch.given()) {
            report_.cells_by_patch = check_patches(view_, findings_);
        }
        if (view_.hull.layer.given()) {
            report_.layers = check_layers(view_, findings_);
        }
    }

    void examine_boundary() {
        if (!sealed_) {
            findings_.skip("Euler characteristic, the caps' boundaries", "there are facets at fault");
        } else if (manifold_) {
            check_euler(view_, report_.counts, findings_);
        }
        if (view_.track.empty()) {
            findings_.skip("tracks, the caps' boundaries", "there is no array track_id");
            return;
        }
        BoundaryChanges<D> changes{view_};
        check_tracks(view_, changes, findings_);
        if (view_.hull.patch.given()) {
            check_patch_columns(view_, findings_);
        }
        if (!sealed_) {
            return;
        }
        const BoundaryFacets<D> boundary = check_cap_boundaries(view_, findings_);
        if (findings_.any({Defect::untracked_boundary, Defect::track_repeats_time})) {
            findings_.skip("comparison of the caps' boundaries", "their tracks are not in order");
        } else {
            check_boundary_image(boundary, changes, findings_);
        }
    }

    CheckOptions options_;
    HullReport report_;
    Findings findings_;
    HullView<D> view_;
    Adjacency<D> adjacency_; ///< empty if the hull's own table is used
    bool confirmed_ = false; ///< the hull's table of neighbours is right
    bool manifold_ = false;
    bool sealed_ = false; ///< every facet is in two cells that agree in orientation
};

} // namespace

template<int D>
void add_measures(const std::array<Measures<D>, 3>& regions, HullReport& report) {
    Point<D + 1> closure{};
    for (std::size_t r = 0; r < 3; ++r) {
        report.cells_by_region[r] = regions[r].cells;
        report.measure_by_region[r] = regions[r].measure;
        report.measure += regions[r].measure;
        report.enclosed += regions[r].enclosed;
        report.angles.smallest = std::min(report.angles.smallest, regions[r].angles.smallest);
        report.angles.largest = std::max(report.angles.largest, regions[r].angles.largest);
        for (std::size_t k = 0; k <= D; ++k) {
            closure[k] += regions[r].closure[k];
        }
    }
    report.closure = norm(closure);
}

template void add_measures<2>(const std::array<Measures<2>, 3>&, HullReport&);
template void add_measures<3>(const std::array<Measures<3>, 3>&, HullReport&);

template<int D>
HullColumns<D> columns_of(const Hull<D>& hull) {
    HullColumns<D> columns;
    columns.points = hull.points;
    columns.cells = hull.cells;
    columns.region = region_column(hull);
    columns.patch = patch_column(hull);
    columns.layer = layer_column(hull);
    columns.neighbors = neighbor_column(std::span<const Neighbors<D>>{hull.neighbors});
    columns.neighbor_table = hull.neighbors;
    columns.vertex_id = integer_column(hull.vertex_ids);
    columns.track_id = integer_column(hull.track_ids);
    columns.patches = hull.patches;
    columns.time = hull.time;
    return columns;
}

template<int D>
HullReport check_hull(const HullColumns<D>& hull, const CheckOptions& options) {
    return HullCheck<D>{hull, options}.run();
}

template HullColumns<2> columns_of<2>(const Hull<2>&);
template HullColumns<3> columns_of<3>(const Hull<3>&);
template HullReport check_hull<2>(const HullColumns<2>&, const CheckOptions&);
template HullReport check_hull<3>(const HullColumns<3>&, const CheckOptions&);

} // namespace slabhull
