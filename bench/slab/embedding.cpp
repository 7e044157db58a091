// SPDX-License-Identifier: BSD-3-Clause
// The proof that a hull does not cross itself: the paper's hulls of the turning ellipsoid, levels
// 1 to 5, on all threads. The rate counts the side's cells. Before its time counts, the proof must find
// nothing on the hull, and crossings on the same hull with two vertices of a cell exchanged.
#include "../growth.h"
#include "../memory.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/slab.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>
#include <utility>

using namespace slabhull;

namespace {

Hull<3> hull_of_level(int level) {
    const Case the_case = experiment_case("ellipsoid", level);
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

/// Two vertices of a side cell at one time, in the middle of the side.
std::pair<Index, Index> vertices_of_a_level(const Hull<3>& hull) {
    for (std::size_t c = hull.initial_cells + hull.side_cells / 2;; ++c) {
        const Simplex<3>& cell = hull.cells[c];
        for (std::size_t i = 1; i < cell.size(); ++i) {
            if (hull.points[cell[i]][3] == hull.points[cell[0]][3]) {
                return {cell[0], cell[i]};
            }
        }
    }
}

bool proof_is_awake(Hull<3>& hull) {
    const auto [v, w] = vertices_of_a_level(hull);
    std::swap(hull.points[v], hull.points[w]);
    const bool found = examine(hull)->crossings > 0;
    std::swap(hull.points[v], hull.points[w]);
    return found && examine(hull)->crossings == 0;
}

void embedding(benchmark::State& state) {
    static bench::Growth growth;
    Hull<3> hull = hull_of_level(static_cast<int>(state.range(0)));
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
BENCHMARK(embedding)->DenseRange(1, 5)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace

BENCHMARK_MAIN();
