// SPDX-License-Identifier: BSD-3-Clause
// Perfect matching of the triangles of closed surfaces, 10^4 to 10^6 of them. Each matching is checked before
// it is timed.
#include "slabhull/topology/matching.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/topology/adjacency.h"
#include "topology/specimens.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

using namespace slabhull;
using specimens::Complex;

namespace {

/// A geodesic ellipsoid, numbered as it is made.
Complex<2> ellipsoid(double triangles) {
    const auto surface =
        ellipsoid_body<3>({0, 0, 0}, {1, 3, 2}, static_cast<int>(std::sqrt(triangles / 20)), {1, "body"});
    return {surface.facets, surface.points.size()};
}

/// All vertices of degree six, numbered at random: its dual graph has no odd cycle but those around the
/// torus.
Complex<2> shuffled_torus(double triangles) {
    return specimens::shuffled<2>(specimens::torus<2>(static_cast<Index>(std::sqrt(triangles / 2))), 1);
}

/// Triangles within triangles, degrees from three up to thousands, numbered at random.
Complex<2> shuffled_fractal(double triangles) {
    auto surface = specimens::sphere<2>();
    while (static_cast<double>(surface.cells.size()) * 2 < triangles) {
        surface = specimens::refined<2>(surface);
    }
    return specimens::shuffled<2>(surface, 1);
}

bool perfect(const Array<Index>& mate, const Array<Neighbors<2>>& neighbors) {
    for (Index f = 0; f < neighbors.size(); ++f) {
        const bool beside =
            std::find(neighbors[f].begin(), neighbors[f].end(), mate[f]) != neighbors[f].end();
        if (mate[f] >= mate.size() || mate[mate[f]] != f || !beside) {
            return false;
        }
    }
    return true;
}

void match(benchmark::State& state, Complex<2> (*make)(double)) {
    const Complex<2> surface = make(static_cast<double>(state.range(0)));
    const auto neighbors = build_adjacency<2>(surface.cells, surface.vertices).neighbors;
    if (!perfect(perfect_matching(neighbors), neighbors)) {
        state.SkipWithError("the matching is not perfect");
        return;
    }
    for (auto run : state) {
        benchmark::DoNotOptimize(perfect_matching(neighbors));
    }
    state.counters["triangles"] = static_cast<double>(surface.cells.size());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(surface.cells.size()));
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(match, ellipsoid, ellipsoid)->Apply(sizes);
BENCHMARK_CAPTURE(match, shuffled_torus, shuffled_torus)->Apply(sizes);
BENCHMARK_CAPTURE(match, shuffled_fractal, shuffled_fractal)->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
