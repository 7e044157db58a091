// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace slabhull;

namespace {

void add_edges(Surface<2>& surface, const std::vector<Point<2>>& polygon, bool hole) {
    const auto first = static_cast<Index>(surface.points.size());
    const auto count = static_cast<Index>(polygon.size());
    surface.points.insert(surface.points.end(), polygon.begin(), polygon.end());
    for (Index i = 0; i < count; ++i) {
        const Index a = first + i;
        const Index b = first + (i + 1) % count;
        surface.facets.push_back(hole ? Facet<2>{a, b} : Facet<2>{b, a});
        surface.patch.push_back(1);
    }
}

/// A square of edge 10 with a round hole of radius 1, all edges about h long.
Surface<2> square_with_hole(double h) {
    const int edges = static_cast<int>(std::ceil(10 / h));
    std::vector<Point<2>> square;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < edges; ++i) {
            const double x = -5 + 10.0 * i / edges;
            const std::array<Point<2>, 4> turned{{{x, -5}, {5, x}, {-x, 5}, {-5, -x}}};
            square.push_back(turned[static_cast<std::size_t>(side)]);
        }
    }
    const int round = static_cast<int>(std::ceil(2 * std::numbers::pi / h));
    std::vector<Point<2>> circle;
    for (int i = 0; i < round; ++i) {
        const double angle = 2 * std::numbers::pi * i / round;
        circle.push_back({std::cos(angle), std::sin(angle)});
    }
    Surface<2> surface;
    add_edges(surface, square, false);
    add_edges(surface, circle, true);
    return surface;
}

/// Triangles of about the wanted number, all of one size. verify_cap() has approved each result.
void mesh_square_with_hole(benchmark::State& state) {
    const double area = 100 - std::numbers::pi;
    const double h = std::sqrt(area * 4 / std::numbers::sqrt3 / static_cast<double>(state.range(0)));
    const Surface<2> surface = square_with_hole(h);
    CapOptions options;
    options.grading.growth = 0;
    CapMesh<2> mesh;
    for (auto run : state) {
        mesh = mesh_cap<2>(surface, options);
    }
    double smallest = 180;
    for (const Simplex<2>& cell : mesh.cells) {
        smallest = std::min(smallest, dihedral_angles<2, 2>(corners_of<2, 2>(cell, mesh.points)).smallest);
    }
    state.counters["triangles"] = static_cast<double>(mesh.cells.size());
    state.counters["smallest_angle"] = smallest;
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.cells.size()));
}
BENCHMARK(mesh_square_with_hole)->Arg(10000)->Arg(100000)->Arg(600000)->Unit(benchmark::kMillisecond);

/// The size field of a circle of many short edges inside a coarse square.
void build_size_field(benchmark::State& state) {
    const Surface<2> surface = square_with_hole(2 * std::numbers::pi / static_cast<double>(state.range(0)));
    const std::span<const Point<2>> points{surface.points};
    const std::vector<double> spacing = boundary_spacing<2>(points, surface.facets);
    for (auto run : state) {
        benchmark::DoNotOptimize(SizeField<2>{points, spacing, Grading{}});
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(build_size_field)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
