// SPDX-License-Identifier: BSD-3-Clause
// Slabs of the turning ellipsoid whose cap is adapted, beside the same slabs with the cap meshed anew
// (TetGen): CPU seconds, smallest angles and cells of the caps, operations per second and shares of them that
// were refused, quality of the simplices over operations and of the others. One line of JSON a slab, medians
// at the end. Each hull and each filling is checked before its time counts.
//
//     bench_slab_adapt [wanted length of edges inside] [slabs] [layers] [radians a slab]
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/filling_quality.h"
#include "slabhull/slab/march.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

using namespace slabhull;

namespace {

Case case_of(double size, double end) {
    Case the_case = experiment_at("ellipsoid", 1);
    the_case.cap_size = size;
    the_case.cap_growth = 0.3;
    the_case.split = Split::A;
    the_case.end = end;
    return the_case;
}

March<3> march_of(const Case& the_case, CapReuse reuse) {
    StageClock clock;
    IdCounter ids;
    MarchState<3> state = march_from<3>(initial_cap<3>(the_case, ids, {}, clock), 0, ids);
    SlabSettings<3> settings = settings_of<3>(the_case, state.boundary);
    settings.reuse = reuse;
    settings.layers.automatic = false;
    settings.layers.suggest = false;
    return {std::move(state), std::move(settings)};
}

double cpu() {
    return cpu_seconds() + cpu_seconds_of_children();
}

/// Least mean ratios of simplices with and without an apex, and how many have one.
struct ConeQuality {
    double of_cones = 1;
    double of_prisms = 1;
    std::size_t cones = 0;
};

ConeQuality cone_quality(const Filling<3>& filling, double time_scale) {
    ConeQuality quality;
    const std::size_t apexes = filling.points.size() - filling.steiner_points;
    for (const Simplex<4>& cell : filling.cells) {
        std::array<Point<4>, 5> corners = corners_of<4, 4>(cell, filling.points);
        double squares = 0;
        for (Point<4>& corner : corners) {
            corner[3] *= time_scale;
        }
        for (std::size_t i = 0; i < 5; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                squares += squared_distance(corners[i], corners[j]);
            }
        }
        const double regular = std::sqrt(5.0) / 96; // of edge 1
        const double ratio = 10 * std::sqrt(signed_measure<4>(corners) / regular) / squares;
        const bool is_cone = std::any_of(cell.begin(), cell.end(), [&](Index v) { return v >= apexes; });
        quality.cones += is_cone ? 1 : 0;
        double& least = is_cone ? quality.of_cones : quality.of_prisms;
        least = std::min(least, ratio);
    }
    return quality;
}

/// CPU time of slab k, and the smallest angle of its cap.
double run(March<3>& march, const std::vector<double>& times, int k, bool adapts) {
    StageClock clock;
    const double begin = cpu();
    Slab<3> slab = march.propose(times, clock);
    const double seconds = cpu() - begin;
    if (!check_hull<3>(slab.hull).clean()) {
        fmt::print(stderr, "the hull is not sound\n");
        std::exit(1);
    }
    const SpatialMesh<3> cap = slab.terminating();
    const double angle = measure_solid<3>(cap.points, cap.cells).angles.smallest;
    fmt::print(R"({{"slab": {}, "cap": "{}", "cells": {}, "cpu": {:.3f}, "smallest_angle": {:.2f})", k,
               adapts ? "adapted" : "meshed", cap.cells.size(), seconds, angle);
    if (adapts) {
        const AdaptReport& report = slab.adapted->report;
        const std::size_t done = report.splits + report.collapses + report.flips;
        const Filling<3> filling = fill_slab(slab, clock);
        if (!check_filling<3>(columns_of(filling), &slab.hull).clean()) {
            fmt::print(stderr, "the filling is not sound\n");
            std::exit(1);
        }
        const FillingQuality all = filling_quality(filling, slab.hull.layers);
        const ConeQuality quality = cone_quality(filling, all.time_scale);
        fmt::print(
            R"(, "splits": {}, "collapses": {}, "flips": {}, "operations_per_second": {:.0f}, "refused": {}, )"
            R"("pentatopes": {}, "of_cones": {}, "per_operation": {:.1f}, "least_mean_ratio_cones": {:.4f}, )"
            R"("least_mean_ratio_prisms": {:.4f})",
            report.splits, report.collapses, report.flips, static_cast<double>(done) / seconds,
            report.refused, filling.cells.size(), quality.cones,
            static_cast<double>(quality.cones) / static_cast<double>(std::max<std::size_t>(done, 1)),
            quality.of_cones, quality.of_prisms);
    }
    fmt::print("}}\n");
    std::fflush(stdout);
    march.accept(std::move(slab));
    return seconds;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

} // namespace

int main(int argc, char** argv) {
    const double size = argc > 1 ? std::atof(argv[1]) : 0.6;
    const int slabs = argc > 2 ? std::atoi(argv[2]) : 5;
    const int layers = argc > 3 ? std::atoi(argv[3]) : 2;
    const double turn = argc > 4 ? std::atof(argv[4]) : 0.05;
    const Case the_case = case_of(size, slabs * turn);
    March<3> adapted = march_of(the_case, CapReuse::adapt);
    March<3> meshed = march_of(the_case, CapReuse::none);
    std::vector<double> ratios;
    for (int k = 0; k < slabs; ++k) {
        std::vector<double> times;
        for (int l = 0; l <= layers; ++l) {
            times.push_back(l == layers ? (k + 1) * turn : (k + static_cast<double>(l) / layers) * turn);
        }
        const double anew = run(meshed, times, k, false);
        ratios.push_back(anew / run(adapted, times, k, true));
    }
    fmt::print(R"({{"median_of_cpu_meshed_over_adapted": {:.2f}}})"
               "\n",
               median(ratios));
    return 0;
}
