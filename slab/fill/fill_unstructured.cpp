// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/describe_hull.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/simplex_sign.h"
#include "slabhull/slab/fill.h"

#include <fmt/format.h>

#include <cmath>

namespace slabhull {

namespace {

/// The time scale by which a layer's duration counts for about the mean edge of the initial cap. A power of
/// two, so that scaling does not round.
double usual_time_scale(const Hull<2>& hull) {
    double edges = 0;
    for (std::size_t c = 0; c < hull.initial_cells; ++c) {
        for (std::size_t i = 0; i < 3; ++i) {
            edges += distance(hull.points[hull.cells[c][i]], hull.points[hull.cells[c][(i + 1) % 3]]);
        }
    }
    const double mean = edges / (3.0 * static_cast<double>(hull.initial_cells));
    return std::exp2(
        std::round(std::log2(mean * static_cast<double>(hull.layers) / (hull.time[1] - hull.time[0]))));
}

/// The hull as the surface of a domain in space, with a patch for each region and patch of the hull.
Surface<3> scaled_surface(const Hull<2>& hull, double time_scale) {
    Surface<3> surface;
    surface.points = hull.points;
    for (Point<3>& point : surface.points) {
        point[2] *= time_scale;
    }
    surface.facets = hull.cells;
    return surface;
}

} // namespace

Filling<2> fill_unstructured(const Hull<2>& hull, StageClock& clock, const UnstructuredFill& options) {
    if (!(options.time_scale >= 0 && std::isfinite(options.time_scale))) {
        throw UsageError{fmt::format("the time scale must be positive, not {}", options.time_scale)};
    }
    const double time_scale = options.time_scale > 0 ? options.time_scale : usual_time_scale(hull);
    CapOptions meshing;
    meshing.blocks = 1;
    CapMesh<3> mesh = mesh_cap<3>(scaled_surface(hull, time_scale), meshing);
    clock.book("filling");
    Filling<2> filling;
    filling.points = std::move(mesh.points);
    std::copy(hull.points.begin(), hull.points.end(), filling.points.begin());
    for (std::size_t v = hull.points.size(); v < filling.points.size(); ++v) {
        filling.points[v][2] /= time_scale;
    }
    filling.cells = std::move(mesh.cells);
    filling.neighbors = std::move(mesh.neighbors);
    filling.steiner_points = filling.points.size() - hull.points.size();
    describe_hull(hull, filling);
    filling.track_ids.append_run(no_track, filling.steiner_points, 0);
    for (std::size_t c = 0; c < filling.cells.size(); ++c) {
        if (simplex_sign<3>(corners_of<3, 3>(filling.cells[c], filling.points)) <= 0) {
            throw GeometryError{
                fmt::format("rounding leaves tetrahedron {} of the filling inside out or flat "
                            "when time is scaled back by {}; take another time scale, best a "
                            "power of two",
                            c, time_scale)};
        }
    }
    clock.book("signs");
    return filling;
}

} // namespace slabhull
