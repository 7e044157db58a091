// SPDX-License-Identifier: BSD-3-Clause
// Fillings of slabs over grids that turn: simplices per second of the filling, its signs and its check, for
// sizes from small to large. One line of JSON per size; each filling is checked before its time counts.
//
//     bench_slab_fill [largest number of cells along an edge] [split]
#include "slabhull/slab/fill.h"
#include "slab/swept_grid.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/check_filling.h"

#include <fmt/format.h>

#include <cstdlib>
#include <numeric>

using namespace slabhull;

namespace {

/// A box of n cells along each edge that turns by a tenth of a radian, its inner vertices, too.
Hull<3> turning_box(Index n, Split split) {
    IdCounter ids;
    SpatialMesh<3> cap = specimens::as_cap<3>(specimens::full_box<3>(n), ids);
    const auto motion = rotation<3>({0, 0, 1}, {0.5 * n, 0.5 * n, 0}, 0.1);
    auto parts = specimens::next_slab<3>(std::move(cap), {0, 0.5, 1}, motion, ids);
    const std::size_t boundary = parts.sweep.boundary.vertex_count();
    std::vector<Index> end(parts.initial.points.size(), no_index);
    for (Index v = 0; v < boundary; ++v) {
        end[parts.sweep.boundary.mesh_vertices()[v]] = v;
    }
    auto next = static_cast<Index>(boundary);
    for (std::size_t v = 0; v < end.size(); ++v) {
        const Point<3>& x = parts.initial.points[v];
        if (end[v] == no_index) {
            end[v] = next++;
            const double c = std::cos(0.1);
            const double s = std::sin(0.1);
            const double dx = x[0] - 0.5 * n;
            const double dy = x[1] - 0.5 * n;
            parts.terminating.points[end[v]] = {0.5 * n + c * dx - s * dy, 0.5 * n + s * dx + c * dy, x[2]};
        }
        parts.initial.track_ids[v] = static_cast<TrackId>(1 + end.size() - v); // as as_cap() on the boundary
        parts.terminating.track_ids[end[v]] = parts.initial.track_ids[v];
    }
    return stitch<3>(parts.initial, parts.sweep, parts.terminating, {split}, ids);
}

} // namespace

int main(int argc, char** argv) {
    const int largest = argc > 1 ? std::atoi(argv[1]) : 64;
    const Split split = split_from_name(argc > 2 ? argv[2] : "A", 3);
    for (Index n = 8; n <= static_cast<Index>(largest); n *= 2) {
        const Hull<3> hull = turning_box(n, split);
        StageClock clock;
        const Filling<3> filling = fill_slab(hull, clock);
        Stopwatch watch;
        const FillingReport report = check_filling<3>(columns_of(filling), &hull);
        const double checking = watch.lap();
        if (!report.clean()) {
            fmt::print(stderr, "{}", findings_as_text(report));
            return 1;
        }
        std::string stages;
        for (const auto& [stage, seconds] : clock.stages()) {
            stages += fmt::format("\"{}\": {:.4g}, ", stage, seconds);
        }
        const auto cells = static_cast<double>(filling.cells.size());
        const double making = clock.total() - clock.stages()[1].second; // caps and places are given
        fmt::print(
            "{{\"split\": \"{}\", \"cells\": {}, \"threads\": {}, {}\"check\": {:.4g}, "
            "\"cells_per_second\": {:.4g}, \"checked_per_second\": {:.4g}, \"bytes_per_cell\": {:.1f}}}\n",
            split_name(split), filling.cells.size(), thread_count(), stages, checking, cells / making,
            cells / checking, static_cast<double>(peak_memory()) / cells);
    }
    return 0;
}
