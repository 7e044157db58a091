// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/mesh_order.h"
#include "../soups.h"
#include "slabhull/core/parallel.h"
#include "slabhull/topology/simplicial_complex.h"

#include <benchmark/benchmark.h>

using namespace slabhull;
using namespace slabhull::bench;

namespace {

const CapMesh<3>& mesh_of(const benchmark::State& state) {
    return soup(static_cast<int>(state.range(0)), state.range(1) != 0 ? CellOrder::curve : CellOrder::mesher)
        .mesh;
}

/// range(1): whether along the curve; range(2): threads.
void set_up(benchmark::State& state, const CapMesh<3>& mesh) {
    set_thread_count(static_cast<int>(state.range(2)));
    state.counters["tets"] = static_cast<double>(mesh.cells.size());
}

void stars(benchmark::State& state) {
    const CapMesh<3>& mesh = mesh_of(state);
    set_up(state, mesh);
    const auto complex = SimplicialComplex<3>::view(mesh.cells, mesh.neighbors, mesh.points.size());
    for (auto run : state) {
        std::size_t met = 0;
        for (const VertexId v : complex.vertices()) {
            met += complex.star(v).size();
        }
        if (met != 4 * mesh.cells.size()) {
            state.SkipWithError("some stars are not whole");
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

/// Adjacency, and the proof that the soup is a manifold.
void open_soup(benchmark::State& state) {
    const CapMesh<3>& mesh = mesh_of(state);
    set_up(state, mesh);
    for (auto run : state) {
        benchmark::DoNotOptimize(SimplicialComplex<3>::from_soup(mesh.cells, mesh.points.size()));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

void reorder(benchmark::State& state) {
    const auto& [mesh, fixed] = soup(static_cast<int>(state.range(0)), CellOrder::mesher);
    set_up(state, mesh);
    for (auto run : state) {
        state.PauseTiming();
        CapMesh<3> copy = mesh;
        state.ResumeTiming();
        order_along_curve<3>(copy, fixed);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

BENCHMARK(stars)->ArgsProduct({{7}, {0, 1}, {1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(open_soup)->ArgsProduct({{7}, {0, 1}, {2}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(reorder)->ArgsProduct({{7}, {0}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace

BENCHMARK_MAIN();
