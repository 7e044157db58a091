// SPDX-License-Identifier: BSD-3-Clause
// What the paths of boundary vertices cost beside the rest of a slab. The domain lies between two ellipsoids
// of the same shape that turn together: all boundary vertices are integrated (rk4, 8 substeps per layer) and
// projected. It is one tetrahedral sheet thick, so caps are as small as they can be, and the terminating cap
// takes the initial one's cells: the rest of the slab is its stitching and its check, without any meshing.
// Seconds are of the processor, on all threads.
#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/stitch.h"
#include "slabhull/slab/tangling.h"
#include "slabhull/topology/adjacency.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>

using namespace slabhull;

namespace {

constexpr Point<3> inner_axes{1, 3, 2};
constexpr double outer_scale = 1.02;
constexpr double rate = std::numbers::pi / 2;

Point<3> scaled(const Point<3>& x) {
    return {outer_scale * x[0], outer_scale * x[1], outer_scale * x[2]};
}

/// The prism between a facet and its image as three tetrahedra, positive; `facet` winds outwards around the
/// body.
std::array<Simplex<3>, 3> sheet_over(Facet<3> facet, Index image) {
    const bool odd = (facet[0] > facet[1]) != ((facet[0] > facet[2]) != (facet[1] > facet[2]));
    std::sort(facet.begin(), facet.end());
    const auto [a, b, c] = facet;
    std::array<Simplex<3>, 3> cells{
        {{a, b, c, c + image}, {a, b, c + image, b + image}, {a, b + image, c + image, a + image}}};
    for (Simplex<3>& cell : cells) {
        if (odd) {
            std::swap(cell[2], cell[3]);
        }
    }
    return cells;
}

SpatialMesh<3> sheet(int divisions, IdCounter& ids) {
    const Surface<3> body = ellipsoid_body<3>({}, inner_axes, divisions, {1, "inner"});
    const auto image = static_cast<Index>(body.points.size());
    SpatialMesh<3> cap;
    cap.points = body.points;
    std::transform(body.points.begin(), body.points.end(), std::back_inserter(cap.points), scaled);
    for (const Facet<3>& facet : body.facets) { // these wind inwards, out of the domain
        for (const Simplex<3>& cell : sheet_over({facet[0], facet[2], facet[1]}, image)) {
            cap.cells.push_back(cell);
        }
    }
    cap.neighbors = build_adjacency<3>(cap.cells, cap.points.size()).neighbors;
    for (const PatchNumber patch : {1, 2}) {
        for (const Facet<3>& facet : body.facets) {
            const Index shift = patch == 1 ? 0 : image;
            cap.boundary_facets.push_back(
                patch == 1 ? facet : Facet<3>{facet[0] + shift, facet[2] + shift, facet[1] + shift});
            cap.boundary_patch.push_back(patch);
        }
    }
    cap.patches = {{1, "inner"}, {2, "outer"}};
    cap.vertex_ids.resize(cap.points.size());
    std::iota(cap.vertex_ids.begin(), cap.vertex_ids.end(), ids.take(cap.points.size()));
    cap.track_ids.resize(cap.points.size());
    std::iota(cap.track_ids.begin(), cap.track_ids.end(), TrackId{0});
    return cap;
}

PatchMotions<3> turning(const MotionPointer<3>& motion) {
    return {{1, {motion, ellipsoid_surface<3>({}, inner_axes)}},
            {2, {motion, ellipsoid_surface<3>({}, scaled(inner_axes))}}};
}

/// The largest distance of vertices from where the closed form has them.
double error_of(const Sweep<3>& sweep) {
    const auto map = rotation<3>({0, 0, 1}, {}, rate)->map(sweep.times.front(), sweep.times.back()).value();
    double worst = 0;
    for (std::size_t v = 0; v < sweep.boundary.vertex_count(); ++v) {
        const Point<3> exact = map(sweep.boundary.start()[v]);
        for (std::size_t k = 0; k < 3; ++k) {
            worst = std::max(worst, std::abs(exact[k] - sweep.positions.back()[v][k]));
        }
    }
    return worst;
}

double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Args: divisions of the ellipsoids, layers.
void trajectories(benchmark::State& state, const MotionPointer<3>& motion, bool project) {
    IdCounter first_ids;
    const SpatialMesh<3> initial = sheet(static_cast<int>(state.range(0)), first_ids);
    const auto layers = static_cast<std::size_t>(state.range(1));
    std::vector<double> times;
    for (std::size_t level = 0; level <= layers; ++level) {
        times.push_back(0.5 * static_cast<double>(level) / static_cast<double>(layers));
    }
    PatchMotions<3> motions = turning(motion);
    if (!project) { // a formula has no closed form to place surfaces by
        motions[1].surface = motions[2].surface = nullptr;
    }
    double moving = 0, boundary = 0, rest = 0;
    for (auto run : state) {
        IdCounter ids = first_ids;
        const double begin = processor_seconds();
        const Sweep<3> sweep = sweep_boundary<3>(boundary_of(initial), initial, motions, 0, times, {});
        const double swept = processor_seconds();
        require_embedded_levels<3>(sweep, motions, 0, {});
        const double embedded = processor_seconds();
        const SpatialMesh<3> terminating = terminating_cap<3>(
            sweep.boundary, {sweep.positions.back(), initial.cells, initial.neighbors}, ids);
        const Hull<3> hull = stitch<3>(initial, sweep, terminating, {Split::C}, ids);
        const bool clean = check_hull<3>(hull).clean();
        const double end = processor_seconds();
        if (!clean || error_of(sweep) > 1e-4) {
            state.SkipWithError("the hull has defects, or the paths went astray");
            return;
        }
        moving += swept - begin;
        boundary += embedded - swept;
        rest += end - embedded;
        state.SetIterationTime(swept - begin);
        state.counters["cells"] = static_cast<double>(hull.cells.size());
    }
    state.counters["vertices"] = static_cast<double>(initial.points.size());
    state.counters["share_without_boundary_check"] = moving / (moving + rest);
    state.counters["share"] = moving / (moving + boundary + rest);
    state.counters["boundary_check_share"] = boundary / (moving + boundary + rest);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(initial.points.size() * layers));
}

/// From 10^4 to 10^6 boundary vertices.
void sizes(benchmark::internal::Benchmark* bench) {
    bench->ArgNames({"divisions", "layers"})
        ->ArgsProduct({{22, 71, 224}, {2, 4}})
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(1);
}
BENCHMARK_CAPTURE(trajectories, rotation_projected, rotation<3>({0, 0, 1}, {}, rate), true)->Apply(sizes);
BENCHMARK_CAPTURE(trajectories, formula,
                  formula_velocity<3>({"-w*y", "w*x", "0"}, std::map<std::string, double>{{"w", rate}}),
                  false)
    ->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
