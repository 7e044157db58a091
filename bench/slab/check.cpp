// SPDX-License-Identifier: BSD-3-Clause
// The check of a hull as `slabhull build` makes it, without Betti numbers and embedding: hulls of the turning
// ellipsoid from 10^5 to 10^7 tetrahedra, on all threads. Before its time counts, the check must find nothing
// on the hull, and something on the same hull with two vertices of a cell exchanged.
#include "slabhull/slab/check.h"
#include "../growth.h"
#include "../memory.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/slab.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <utility>

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

bool check_is_awake(Hull<3>& hull) {
    Simplex<3>& victim = hull.cells[hull.cells.size() / 2];
    std::swap(victim[0], victim[1]);
    const bool found = check_hull<3>(hull).count(Defect::disoriented_facet) == 4;
    std::swap(victim[0], victim[1]);
    return found && check_hull<3>(hull).clean();
}

void check(benchmark::State& state) {
    static bench::Growth growth;
    Hull<3> hull = hull_of(static_cast<double>(state.range(0)));
    if (!check_is_awake(hull)) {
        state.SkipWithError("the check does not tell a sound hull from a damaged one");
        return;
    }
    const auto tets = static_cast<double>(hull.cells.size());
    double extra = 0;
    for (auto run : state) {
        const bench::PeakMemory memory;
        const Stopwatch watch;
        benchmark::DoNotOptimize(check_hull<3>(hull));
        growth.add(tets, watch.seconds());
        extra = memory.more();
    }
    state.counters["tets"] = tets;
    state.counters["threads"] = thread_count();
    state.counters["extra_bytes_per_tet"] = extra / tets;
    if (growth.known()) {
        state.counters["growth"] = growth.exponent();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hull.cells.size()));
}
BENCHMARK(check)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(5'000'000)
    ->Arg(10'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace

BENCHMARK_MAIN();
