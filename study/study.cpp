// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/study/study.h"
#include "slabhull/cases/settings.h"

#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/slab/caps_ahead.h"
#include "slabhull/slab/slab.h"
#include "slabhull/slab/sound_hull.h"
#include "slabhull/study/exact_measures.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace slabhull {

namespace {

template<int D>
CellShapes shapes_of(const Hull<D>& hull, std::span<const Simplex<D>> cells) {
    const std::span<const Point<D + 1>> points = hull.points;
    return {measure_cells<D>(points, cells).angles, angle_histogram<D, D + 1>(points, cells),
            aspect_ratios<D, D + 1>(points, cells)};
}

CellShapes together(const CellShapes& a, std::size_t cells_of_a, const CellShapes& b,
                    std::size_t cells_of_b) {
    CellShapes both = a;
    both.angles.smallest = std::min(a.angles.smallest, b.angles.smallest);
    both.angles.largest = std::max(a.angles.largest, b.angles.largest);
    std::transform(b.histogram.begin(), b.histogram.end(), a.histogram.begin(), both.histogram.begin(),
                   std::plus<>{});
    const auto na = static_cast<double>(cells_of_a);
    const auto nb = static_cast<double>(cells_of_b);
    both.aspect.mean = (na * a.aspect.mean + nb * b.aspect.mean) / (na + nb);
    both.aspect.largest = std::max(a.aspect.largest, b.aspect.largest);
    return both;
}

template<int D>
void add_shapes(StudyRow& row, const Hull<D>& hull) {
    const std::span<const Simplex<D>> cells = hull.cells;
    row.side = shapes_of<D>(hull, cells.subspan(hull.initial_cells, hull.side_cells));
    const auto initial = cells.first(hull.initial_cells);
    const auto terminating = cells.subspan(hull.terminating_begin());
    row.caps = together(shapes_of<D>(hull, initial), initial.size(), shapes_of<D>(hull, terminating),
                        terminating.size());
}

void add_measures(StudyRow& row, const HullReport& report) {
    const auto& parts = report.measure_by_region;
    row.measured = {report.measure, parts[0], parts[1], parts[2], report.enclosed};
    const ExactMeasures exact = exact_measures(row.experiment);
    row.exact = {exact.hull(), exact.initial, exact.side, exact.terminating, exact.enclosed};
    row.closure = report.closure;
}

StudyRow row_for(const Case& the_case) {
    StudyRow row;
    row.experiment = the_case.experiment;
    row.level = the_case.level;
    row.dimension = the_case.dimension;
    row.split = split_name(the_case.split);
    row.paper = experiment_levels(the_case.experiment)[static_cast<std::size_t>(the_case.level - 1)].paper;
    return row;
}

void write(const std::filesystem::path& path, const auto& hull) {
    io::AtomicFiles files;
    write_hull(files, path, hull, path.extension().string().substr(1));
    files.commit();
}

/// The slab of an experiment, both of its caps meshed at once.
template<int D>
Slab<D> build_experiment(const Case& the_case, const std::vector<double>& times, Boundary<D>& boundary,
                         StageClock& clock) {
    std::optional<CapsAhead<D>> ahead;
    Domain<D> domain = initial_domain<D>(the_case, {}, {}, clock, [&](const SpatialMesh<D>& mesh) {
        const Boundary<D> alone = boundary_of(mesh);
        ahead.emplace(alone, mesh, times.front(), settings_of<D>(the_case, alone), [&times](double begin) {
            return begin < times.back() ? times : std::vector<double>{};
        });
    });
    boundary = boundary_of(domain.mesh);
    std::optional<PreparedSlab<D>> prepared = ahead->take(boundary, times);
    clock.book("waiting for caps");
    ahead.reset();
    const auto settings = settings_of<D>(the_case, boundary);
    return prepared ? build_slab<D>(std::move(domain.mesh), boundary, 0, *std::move(prepared), settings,
                                    domain.ids, clock)
                    : build_slab<D>(std::move(domain.mesh), boundary, 0, times, settings, domain.ids, clock);
}

template<int D>
StudyRow study(const Case& the_case, const std::optional<std::filesystem::path>& hull_file) {
    StudyRow row = row_for(the_case);
    StageClock clock;
    const std::vector<double> times = the_case.level_times(0);
    Boundary<D> boundary;
    const Slab<D> slab = build_experiment<D>(the_case, times, boundary, clock);
    row.layers = times.size() - 1;
    row.boundary_facets = boundary.facet_count();
    row.centres = slab.hull.side_points - boundary.vertex_count() * (row.layers - 1);

    const std::string name = fmt::format("the hull of {}, level {},", row.experiment, row.level);
    const HullReport report = require_sound_hull<D>(slab.hull, name, the_case.check_embedding, clock).report;
    row.counts = {report.counts.cells, report.counts.vertices};
    row.cells_by_region = report.cells_by_region;
    add_measures(row, report);
    add_shapes<D>(row, slab.hull);
    clock.book("quality");
    if (hull_file) {
        write(*hull_file, slab.hull);
        clock.book("writing");
    }
    row.seconds = clock.stages();
    return row;
}

template<class Value>
std::optional<double> growth(const StudySeries& series, const Value& value) {
    std::vector<std::array<double, 2>> xy;
    for (const StudyRow& row : series) {
        xy.push_back({static_cast<double>(row.counts.cells), value(row)});
    }
    return power_law(xy);
}

} // namespace

double StudyRow::total_seconds() const {
    double total = 0;
    for (const auto& [stage, passed] : seconds) {
        total += passed;
    }
    return total;
}

StudyRow study_level(const Case& the_case, const std::optional<std::filesystem::path>& hull_file) {
    StudyRow row = the_case.dimension == 2 ? study<2>(the_case, hull_file) : study<3>(the_case, hull_file);
    row.cpu_seconds = cpu_seconds() + cpu_seconds_of_children();
    row.peak_bytes = peak_memory();
    row.mesher_peak_bytes = peak_memory_of_children();
    return row;
}

std::optional<double> power_law(const std::vector<std::array<double, 2>>& xy) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& [x, y] : xy) {
        if (!(x > 0 && y > 0)) {
            return std::nullopt;
        }
        const double lx = std::log(x / xy.front()[0]); // shifted, so that equal x give exactly zero
        const double ly = std::log(y);
        sx += lx;
        sy += ly;
        sxx += lx * lx;
        sxy += lx * ly;
    }
    const auto n = static_cast<double>(xy.size());
    const double spread = n * sxx - sx * sx;
    return spread > 1e-12 ? std::optional{(n * sxy - sx * sy) / spread} : std::nullopt;
}

std::vector<StudySeries> series_of(const std::vector<StudyRow>& rows) {
    std::vector<StudySeries> all;
    for (const StudyRow& row : rows) {
        const auto same = std::find_if(all.begin(), all.end(), [&row](const StudySeries& series) {
            return series.front().experiment == row.experiment && series.front().split == row.split;
        });
        (same != all.end() ? *same : all.emplace_back()).push_back(row);
    }
    for (StudySeries& series : all) {
        std::stable_sort(series.begin(), series.end(),
                         [](const StudyRow& a, const StudyRow& b) { return a.level < b.level; });
    }
    return all;
}

std::optional<double> order_of(const StudySeries& series, std::size_t measure) {
    const auto exponent = growth(series, [&](const StudyRow& row) { return std::abs(row.error(measure)); });
    return exponent ? std::optional{-*exponent * series.front().dimension} : std::nullopt;
}

std::optional<double> time_growth(const StudySeries& series) {
    return growth(series, [](const StudyRow& row) { return row.cpu_seconds; });
}

std::optional<double> memory_growth(const StudySeries& series) {
    return growth(series, [](const StudyRow& row) { return static_cast<double>(row.peak()); });
}

} // namespace slabhull
