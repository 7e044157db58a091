// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/describe_hull.h"
#include "slab/fill/layer_scale.h"
#include "slab/fill/mend_cells.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/fill.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

namespace slabhull {

namespace {

/// A layer lasts about the mean edge of the initial cap. A power of two, so that scaling does not round.
double usual_time_scale(const Hull<2>& hull) {
    const std::span<const Simplex<2>> cap = std::span{hull.cells}.first(hull.initial_cells);
    return std::exp2(std::round(std::log2(layer_scale<2>(cap, hull.points, hull.layers, hull.time))));
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

/// Refusals say how time was scaled, which they may be due to.
CapMesh<3> mesh_scaled(const Hull<2>& hull, double time_scale) {
    CapOptions meshing;
    meshing.blocks = 1;
    try {
        return mesh_cap<3>(scaled_surface(hull, time_scale), meshing);
    } catch (const GeometryError& error) {
        throw GeometryError{
            fmt::format("{}. A unit of time counts for the length {:g} there: another time scale may help",
                        error.what(), time_scale),
            error.entities};
    }
}

} // namespace

Filling<2> fill_unstructured(const Hull<2>& hull, StageClock& clock, const UnstructuredFill& options) {
    if (!(options.time_scale >= 0 && std::isfinite(options.time_scale))) {
        throw UsageError{fmt::format("the time scale must be positive, not {}", options.time_scale)};
    }
    const double time_scale = options.time_scale > 0 ? options.time_scale : usual_time_scale(hull);
    CapMesh<3> mesh = mesh_scaled(hull, time_scale);
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
    if (const std::vector<Index> bad = not_positive(filling); !bad.empty()) {
        throw GeometryError{
            fmt::format("rounding leaves tetrahedron {} of the filling inside out or flat when "
                        "time is scaled back by {}; take another time scale, best a power of two",
                        bad.front(), time_scale)};
    }
    clock.book("signs");
    return filling;
}

} // namespace slabhull
