// SPDX-License-Identifier: BSD-3-Clause
// Stitching, caps given: ids, points, cells and adjacency of the hull. Each hull is compared with the
// adjacency of its soup before it is timed.
#include "slabhull/slab/stitch.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/topology/adjacency.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>

using namespace slabhull;

namespace {

/// Vertices of an n^3 grid of cubes, those on the boundary first.
class GridVertices {
public:
    explicit GridVertices(Index n) : n_{n} {
        number_.resize((n + 1) * (n + 1) * (n + 1));
        for (const bool boundary : {true, false}) {
            for (Index at = 0; at < number_.size(); ++at) {
                if (on_boundary(place(at)) == boundary) {
                    number_[at] = static_cast<Index>(points.size());
                    const auto [x, y, z] = place(at);
                    points.push_back({double(x), double(y), double(z)});
                    boundary_points += boundary ? 1 : 0;
                }
            }
        }
    }
    Index operator()(const std::array<Index, 3>& at) const {
        return number_[(at[2] * (n_ + 1) + at[1]) * (n_ + 1) + at[0]];
    }
    Array<Point<3>> points;
    std::size_t boundary_points = 0;

private:
    std::array<Index, 3> place(Index at) const {
        return {at % (n_ + 1), at / (n_ + 1) % (n_ + 1), at / (n_ + 1) / (n_ + 1)};
    }
    bool on_boundary(const std::array<Index, 3>& at) const {
        return std::any_of(at.begin(), at.end(), [this](Index k) { return k == 0 || k == n_; });
    }
    Index n_;
    Array<Index> number_;
};

/// Each cube as six tetrahedra along its diagonal, positive.
Array<Simplex<3>> grid_cells(Index n, const GridVertices& vertex) {
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}}; // the odd ones last
    Array<Simplex<3>> cells;
    for (Index cube = 0; cube < n * n * n; ++cube) {
        for (std::size_t order = 0; order < 6; ++order) {
            std::array<Index, 3> at{cube % n, cube / n % n, cube / n / n};
            Simplex<3> cell{vertex(at)};
            for (std::size_t k = 0; k < 3; ++k) {
                ++at[orders[order][k]];
                cell[k + 1] = vertex(at);
            }
            if (order >= 3) {
                std::swap(cell[2], cell[3]);
            }
            cells.push_back(cell);
        }
    }
    return cells;
}

SpatialMesh<3> grid_cap(Index n, IdCounter& ids) {
    GridVertices vertices{n};
    SpatialMesh<3> cap;
    cap.cells = grid_cells(n, vertices);
    cap.neighbors = build_adjacency<3>(cap.cells, vertices.points.size()).neighbors;
    for (std::size_t c = 0; c < cap.cells.size(); ++c) {
        for (std::size_t i = 0; i < 4; ++i) {
            if (cap.neighbors[c][i] == no_index) {
                cap.boundary_facets.push_back(outward_facet<3>(cap.cells[c], static_cast<int>(i)));
            }
        }
    }
    cap.boundary_patch.assign(cap.boundary_facets.size(), 1);
    cap.patches = {{1, "walls"}};
    cap.vertex_ids.resize(vertices.points.size());
    std::iota(cap.vertex_ids.begin(), cap.vertex_ids.end(), ids.take(vertices.points.size()));
    cap.track_ids.assign(vertices.points.size(), no_track);
    std::iota(cap.track_ids.begin(),
              cap.track_ids.begin() + static_cast<std::ptrdiff_t>(vertices.boundary_points), 0);
    cap.points = std::move(vertices.points);
    return cap;
}

/// A standing cube of n^3 cubes over `layers` layers.
struct Parts {
    Parts(Index n, std::size_t layers) : initial{grid_cap(n, ids)} {
        std::vector<double> times(layers + 1);
        std::iota(times.begin(), times.end(), 0.0);
        sweep = sweep_boundary<3>(boundary_of(initial), initial, {}, 0, times, {});
        terminating =
            terminating_cap<3>(sweep.boundary, {initial.points, initial.cells, initial.neighbors}, ids);
    }
    Hull<3> stitched(const SideOptions& side) { return stitch<3>(initial, sweep, terminating, side, ids); }

    IdCounter ids;
    SpatialMesh<3> initial;
    Sweep<3> sweep;
    SpatialMesh<3> terminating;
};

void stitch_hull(benchmark::State& state, const SideOptions& side) {
    Parts parts{static_cast<Index>(state.range(0)), static_cast<std::size_t>(state.range(1))};
    Hull<3> hull = parts.stitched(side);
    const Adjacency<3> soup = build_adjacency<3>(hull.cells, hull.points.size());
    if (!soup.defects.empty() || soup.neighbors != hull.neighbors) {
        state.SkipWithError("the adjacency by construction is not that of the soup");
        return;
    }
    for (auto run : state) {
        state.PauseTiming();
        hull = {}; // a new hull meets fresh memory, as in a march
        state.ResumeTiming();
        hull = parts.stitched(side);
    }
    state.counters["tets"] = static_cast<double>(hull.cells.size());
    state.counters["side"] = static_cast<double>(hull.side_cells);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(hull.cells.size()));
}

/// From 10^5 to 10^7 tetrahedra in split C.
void sizes(benchmark::internal::Benchmark* bench) {
    bench->Args({16, 2})
        ->Args({34, 3})
        ->Args({55, 4})
        ->Args({80, 5})
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}
void one_size(benchmark::internal::Benchmark* bench) {
    bench->Args({55, 4})->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK_CAPTURE(stitch_hull, C, SideOptions{Split::C})->Apply(sizes);
BENCHMARK_CAPTURE(stitch_hull, A, SideOptions{Split::A})->Apply(one_size);
BENCHMARK_CAPTURE(stitch_hull, B, SideOptions{Split::B})->Apply(one_size);
BENCHMARK_CAPTURE(stitch_hull, B_smallest_id, SideOptions{Split::B, Diagonals::smallest_id})->Apply(one_size);
BENCHMARK_CAPTURE(stitch_hull, D, SideOptions{Split::D})->Apply(one_size);
BENCHMARK_CAPTURE(stitch_hull, E, SideOptions{Split::E})->Apply(one_size);

} // namespace

BENCHMARK_MAIN();
