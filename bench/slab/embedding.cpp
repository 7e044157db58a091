// SPDX-License-Identifier: BSD-3-Clause
// The proof that a hull does not cross itself: hulls of the turning ellipsoid from 10^5 to 10^7 tetrahedra,
// on all threads. The rate counts the side's cells. Before its time counts, the proof must find nothing on
// the hull, and crossings on the same hull with a vertex between the caps moved by a tenth of the box.
#include "../growth.h"
#include "../memory.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/child_process.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/slab.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>

using namespace slabhull;

namespace {

/// The experiment's hull with about so many tetrahedra; refinement 1.187 gives 367,000.
Hull<3> hull_of(double tets) {
    const Case the_case = experiment_at("ellipsoid", 1.187 * std::cbrt(tets / 367'000), Bulk::caps);
    IdCounter ids;
    StageClock clock;
    const SpatialMesh<3> cap = initial_cap<3>(the_case, ids, {}, clock);
    const auto settings = settings_of<3>(the_case, boundary_of(cap));
    return build_slab<3>(cap, boundary_of(cap), 0, the_case.level_times(0), settings, ids, clock).hull;
}

std::optional<EmbeddingSummary> examine(const Hull<3>& hull) {
    HullReport report;
    report.table_confirmed = true; // the builder's, as after check_hull()
    return check_embedding<3>(columns_of(hull), {}, report);
}

bool proof_is_awake(Hull<3>& hull) {
    const std::size_t middle = hull.initial_cells + hull.side_cells / 2;
    Point<4>& victim = hull.points[hull.cells[middle][0]];
    const double x = std::exchange(victim[0], victim[0] + 1.6);
    const bool found = examine(hull)->crossings > 0;
    victim[0] = x;
    return found && examine(hull)->crossings == 0;
}

void embedding(benchmark::State& state) {
    static bench::Growth growth;
    Hull<3> hull = hull_of(static_cast<double>(state.range(0)));
    if (!proof_is_awake(hull)) {
        state.SkipWithError("the proof does not tell a sound hull from one that crosses itself");
        return;
    }
    const auto cells = static_cast<double>(hull.side_cells);
    double extra = 0;
    double cpu = 0;
    for (auto run : state) {
        const bench::PeakMemory memory;
        const Stopwatch watch;
        const double before = cpu_seconds();
        benchmark::DoNotOptimize(examine(hull));
        cpu += cpu_seconds() - before;
        growth.add(cells, watch.seconds());
        extra = memory.more();
    }
    state.counters["side_cells"] = cells;
    state.counters["threads"] = thread_count();
    state.counters["cells_per_cpu_second"] = cells * static_cast<double>(state.iterations()) / cpu;
    state.counters["extra_bytes_per_cell"] = extra / cells;
    if (growth.known()) {
        state.counters["growth"] = growth.exponent();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hull.side_cells));
}
BENCHMARK(embedding)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Arg(30'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace

BENCHMARK_MAIN();
