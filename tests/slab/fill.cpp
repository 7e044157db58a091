// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/fill.h"

#include "slab/swept_grid.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check_filling.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

using namespace slabhull;

namespace {

/// Every vertex of the caps on a track, as in a march that moves its caps. Tracks run against the numbers.
template<int D>
void track_inside(SpatialMesh<D>& initial, SpatialMesh<D>& terminating, const Boundary<D>& boundary) {
    const std::size_t count = initial.points.size();
    std::size_t next = boundary.vertex_count();
    std::vector<Index> image(count, no_index);
    for (Index v = 0; v < boundary.vertex_count(); ++v) {
        image[boundary.mesh_vertices()[v]] = v;
    }
    for (std::size_t v = 0; v < count; ++v) {
        initial.track_ids[v] = static_cast<TrackId>(1 + count - v);
        const std::size_t end = image[v] == no_index ? next++ : image[v];
        terminating.track_ids[end] = initial.track_ids[v];
    }
}

template<int D>
MotionPointer<D> turn() {
    Point<D> axis{}; // not looked at for D = 2
    axis[D - 1] = 1;
    return rotation<D>(axis, {}, 0.4);
}

/// The hull of a grid that turns or stands.
template<int D>
Hull<D> hull_over(const specimens::Grid<D>& grid, const SideOptions& side, std::size_t layers, bool turns) {
    IdCounter ids;
    std::vector<double> times;
    for (std::size_t k = 0; k <= layers; ++k) {
        times.push_back(0.5 + 0.25 * static_cast<double>(k) / static_cast<double>(layers));
    }
    auto parts =
        specimens::next_slab<D>(specimens::as_cap<D>(grid, ids), times, turns ? turn<D>() : nullptr, ids);
    track_inside<D>(parts.initial, parts.terminating, parts.sweep.boundary);
    return stitch<D>(parts.initial, parts.sweep, parts.terminating, side, ids);
}

template<int D>
std::vector<Split> splits() {
    if constexpr (D == 2) {
        return {Split::diagonal, Split::centre};
    } else {
        return {Split::A, Split::B, Split::C, Split::D, Split::E};
    }
}

template<int D>
void require_clean(const Filling<D>& filling, const Hull<D>& hull) {
    const FillingReport report = check_filling<D>(columns_of(filling), &hull);
    INFO(findings_as_text(report));
    REQUIRE(report.clean());
    CHECK(report.boundary_facets == hull.cells.size());
    CHECK(report.volume == Approx(check_hull<D>(columns_of(hull)).enclosed).epsilon(1e-12));
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a slab over a grid is filled, whatever the split of its side", "[fill]", ((int D), D),
                       2, 3) {
    for (const Split split : splits<D>()) {
        for (const std::size_t layers : {1u, 3u}) {
            for (const bool turns : {false, true}) {
                INFO(split_name(split)
                     << " with " << layers << " layers, " << (turns ? "turning" : "at rest"));
                const Hull<D> hull = hull_over<D>(specimens::full_box<D>(3), {split}, layers, turns);
                require_clean(fill_slab(hull), hull);
            }
        }
    }
}
