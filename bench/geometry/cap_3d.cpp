// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/shapes.h"

#include <benchmark/benchmark.h>

#include <array>
#include <map>

using namespace slabhull;

namespace {

/// A cube of edge 10 around a unit sphere, all edges about 1.2 / divisions long.
Surface<3> sphere_in_cube(int divisions) {
    return join<3>(std::array{ellipsoid_body<3>({0, 0, 0}, {1, 1, 1}, divisions, {1, "sphere"}),
                              box_surface<3>({-5, -5, -5}, {5, 5, 5}, 1.2 / divisions, {2, "box"})});
}

/// Tetrahedra per second in one piece, and their smallest angle, by mesher and size.
struct Whole {
    double rate = 0;
    double angle = 0;
};
std::map<std::pair<std::int64_t, std::int64_t>, Whole> whole;

/// Arguments: mesher (0 TetGen, 1 HXT), divisions, blocks, threads. verify_cap() has approved each result.
void mesh_sphere_in_cube(benchmark::State& state) {
    const auto mesher = state.range(0) == 1 ? SolidMesher::hxt : SolidMesher::tetgen;
    if (!has_mesher(mesher)) {
        state.SkipWithError("not in this build");
        return;
    }
    const auto divisions = static_cast<int>(state.range(1));
    const Surface<3> surface = sphere_in_cube(divisions);
    CapOptions options;
    options.grading.largest = 1.2 / divisions;
    options.mesher = mesher;
    options.blocks = static_cast<int>(state.range(2));
    set_thread_count(static_cast<int>(state.range(3)));
    const std::size_t peak_before = peak_memory_of_children();
    CapMesh<3> mesh;
    const Stopwatch watch;
    for (auto run : state) {
        mesh = mesh_cap<3>(surface, options);
    }
    const auto cells = static_cast<double>(mesh.cells.size());
    const double rate = cells * static_cast<double>(state.iterations()) / watch.seconds();
    set_thread_count(0);
    const double angle = measure_solid<3>(mesh.points, mesh.cells).angles.smallest;
    const auto key = std::pair{state.range(0), state.range(1)};
    if (options.blocks == 1) {
        whole[key] = {rate, angle};
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
    state.counters["tets"] = cells;
    state.counters["smallest_angle"] = angle;
    state.counters["blocks"] = mesh.blocks;
    state.counters["rate_by_whole"] = rate / whole[key].rate;
    state.counters["angle_by_whole"] = angle / whole[key].angle;
    // The system tells the largest child ever: known for those that were larger than all before.
    if (peak_memory_of_children() > peak_before) {
        state.counters["mesher_bytes_per_tet"] = static_cast<double>(peak_memory_of_children()) / cells;
    }
}

void sizes_and_blocks(benchmark::internal::Benchmark* bench) {
    for (const int mesher : {0, 1}) {
        for (const int divisions : {6, 9}) { // 0.9 and 3 million tetrahedra
            bench->Args({mesher, divisions, 1, 1});
            bench->Args({mesher, divisions, 2, 2});
            bench->Args({mesher, divisions, 4, 2});
        }
    }
}
BENCHMARK(mesh_sphere_in_cube)
    ->ArgNames({"hxt", "divisions", "blocks", "threads"})
    ->Apply(sizes_and_blocks)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
