// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/mesh_order.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/simplicial_complex.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

using namespace slabhull;

namespace {

struct Cap {
    CapMesh<3> mesh;
    std::size_t fixed = 0; ///< points of the boundary
};

/// A cube of edge 10 around a unit sphere of `divisions`, with the sphere's spacing everywhere.
const Cap& cap(int divisions, bool along_curve) {
    static std::map<std::pair<int, bool>, Cap> made;
    Cap& result = made[{divisions, along_curve}];
    if (result.fixed == 0 && along_curve) {
        result = cap(divisions, false);
        order_along_curve<3>(result.mesh, result.fixed);
    } else if (result.fixed == 0) {
        const auto sphere = ellipsoid_body<3>({0, 0, 0}, {1, 1, 1}, divisions, {1, "sphere"});
        const double spacing = 1.2 / divisions;
        const auto box = box_surface<3>({-5, -5, -5}, {5, 5, 5}, spacing, {2, "box"});
        const auto surface = join<3>(std::array{sphere, box});
        CapOptions options;
        options.grading = {0.3, spacing};
        result = {mesh_cap<3>(surface, options), surface.points.size()};
    }
    return result;
}

/// range(1): whether along the curve; range(2): threads.
void set_up(benchmark::State& state, const CapMesh<3>& mesh) {
    set_thread_count(static_cast<int>(state.range(2)));
    state.counters["tets"] = static_cast<double>(mesh.cells.size());
}

void adjacency(benchmark::State& state) {
    const CapMesh<3>& mesh = cap(static_cast<int>(state.range(0)), state.range(1) != 0).mesh;
    set_up(state, mesh);
    for (auto run : state) {
        const auto found = build_adjacency<3>(mesh.cells, mesh.points.size());
        if (!std::equal(found.neighbors.begin(), found.neighbors.end(), mesh.neighbors.begin())) {
            state.SkipWithError("not the mesher's neighbours");
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

void stars(benchmark::State& state) {
    const CapMesh<3>& mesh = cap(static_cast<int>(state.range(0)), state.range(1) != 0).mesh;
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
    const CapMesh<3>& mesh = cap(static_cast<int>(state.range(0)), state.range(1) != 0).mesh;
    set_up(state, mesh);
    for (auto run : state) {
        benchmark::DoNotOptimize(SimplicialComplex<3>::from_soup(mesh.cells, mesh.points.size()));
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

void reorder(benchmark::State& state) {
    const auto& [mesh, fixed] = cap(static_cast<int>(state.range(0)), false);
    set_up(state, mesh);
    for (auto run : state) {
        state.PauseTiming();
        CapMesh<3> copy = mesh;
        state.ResumeTiming();
        order_along_curve<3>(copy, fixed);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}

BENCHMARK(adjacency)->ArgsProduct({{7}, {0, 1}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(stars)->ArgsProduct({{7}, {0, 1}, {1}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(open_soup)->ArgsProduct({{7}, {0, 1}, {2}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(reorder)->ArgsProduct({{7}, {0}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace

BENCHMARK_MAIN();
