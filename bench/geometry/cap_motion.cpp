// SPDX-License-Identifier: BSD-3-Clause
// Moving a cap against meshing it anew, on an ellipsoid that turns by 0.02 rad in a box. CPU time, that of
// TetGen's process included. Each result is checked before its time counts: a moved cap by verify_cap() and
// its smallest angle.
#include "slabhull/geometry/cap_motion.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/shapes.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numeric>

using namespace slabhull;

namespace {

/// Seconds of CPU of this process and of its ended children.
double cpu_of_all() {
    return cpu_seconds() + cpu_seconds_of_children();
}

template<int D>
struct Turning {
    Surface<D> before;
    Surface<D> after;
    CapMesh<D> mesh;
    std::vector<Index> boundary;
    double seconds = 0; ///< of meshing
};

template<int D>
CapOptions options_for(double refinement) {
    CapOptions options;
    options.grading = {(D == 3 ? 0.1 : 0.2) / refinement, 1.2 / refinement};
    return options;
}

/// The spacings of the paper's ellipsoid, divided by range(0) / 100.
template<int D>
const Turning<D>& turning(benchmark::State& state) {
    static std::map<std::int64_t, Turning<D>> made;
    Turning<D>& result = made[state.range(0)];
    if (result.boundary.empty()) {
        const double refinement = static_cast<double>(state.range(0)) / 100;
        Point<D> axes{1, 3};
        Point<D> corner;
        Point<D> opposite;
        corner.fill(8);
        opposite.fill(-8);
        if constexpr (D == 3) {
            axes[2] = 2;
        }
        const auto body =
            ellipsoid_body<D>({}, axes, ellipsoid_divisions<D>(axes, 0.3 / refinement), {1, "body"});
        const auto box = box_surface<D>(opposite, corner, 1.2 / refinement, {2, "box"});
        result.before = join<D>(std::array{body, box});
        result.after = result.before;
        for (std::size_t v = 0; v < body.points.size(); ++v) {
            Point<D>& p = result.after.points[v];
            const auto [x, y] = std::pair{p[0], p[1]};
            p[0] = std::cos(0.02) * x - std::sin(0.02) * y;
            p[1] = std::sin(0.02) * x + std::cos(0.02) * y;
        }
        const double start = cpu_of_all();
        result.mesh = mesh_cap<D>(result.before, options_for<D>(refinement));
        result.seconds = cpu_of_all() - start;
        result.boundary.resize(result.before.points.size());
        std::iota(result.boundary.begin(), result.boundary.end(), Index{0});
    }
    return result;
}

template<int D>
void move_with_body(benchmark::State& state) {
    set_thread_count(1);
    const Turning<D>& turn = turning<D>(state);
    const auto move = [&] {
        return move_cap<D>(turn.mesh.points, turn.mesh.cells, turn.boundary, turn.after.points);
    };
    const MovedCap<D> moved = move();
    const double angle = measure_solid<D>(turn.mesh.points, turn.mesh.cells).angles.smallest;
    verify_cap<D>({moved.points, turn.mesh.cells, turn.mesh.neighbors}, turn.after);
    if (!moved.sound || moved.smallest_angle < 0.9 * angle) {
        state.SkipWithError("the moved cap is not as good as the meshed one");
        return;
    }
    double seconds = 0;
    for (auto run : state) {
        const double start = cpu_of_all();
        benchmark::DoNotOptimize(move());
        const double passed = cpu_of_all() - start;
        state.SetIterationTime(passed);
        seconds += passed;
    }
    const auto cells = static_cast<double>(turn.mesh.cells.size());
    state.counters["cells"] = cells;
    state.counters["iterations"] = moved.iterations;
    state.counters["angle_before"] = angle;
    state.counters["angle"] = moved.smallest_angle;
    state.counters["meshing_over_moving"] = turn.seconds * static_cast<double>(state.iterations()) / seconds;
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(turn.mesh.cells.size()));
    state.SetComplexityN(static_cast<std::int64_t>(turn.mesh.cells.size()));
}

BENCHMARK_TEMPLATE(move_with_body, 3)
    ->Arg(107)
    ->Arg(230)
    ->Arg(332)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Complexity(benchmark::oN);
BENCHMARK_TEMPLATE(move_with_body, 2)->Arg(2000)->Arg(6000)->Unit(benchmark::kMillisecond)->UseManualTime();

} // namespace

BENCHMARK_MAIN();
