// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/cap_spacing.h"
#include "geometry/meshing/constrained_delaunay.h"
#include "geometry/meshing/delaunay_refinement.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/mesh_order.h"

#include <fmt/format.h>

#include <functional>
#include <numbers>
#include <span>

namespace slabhull {

namespace {

/// SizeField::cube_count(), where it can be met: a tiny edge without growth would ask for triangles until
/// memory is full.
double countable_cubes(const SizeField<2>& field) {
    const double cubes = field.cube_count();
    const double wanted = cubes * 4 / std::numbers::sqrt3;
    if (!(wanted < static_cast<double>(no_index))) {
        throw LimitError{
            fmt::format("the spacing of the boundary and its growth ask for about {:.2g} triangles; allow "
                        "a larger growth or remove the shortest edges",
                        wanted)};
    }
    return cubes;
}

CapMesh<2> mesh_alone(const Surface<2>& surface, const CapOptions& options) {
    CapMesh<2> mesh = constrained_delaunay(surface);
    require_attainable<2>(surface, options.grading.largest);
    const std::span<const Point<2>> points{surface.points};
    const SizeField<2> field{points, boundary_spacing<2>(points, surface.facets), options.grading};
    expect_work(static_cast<std::uint64_t>(cells_per_cube<2> * countable_cubes(field)));
    refine_delaunay(mesh, {surface, std::cref(field), options.grading.growth}, options.min_angle);

    order_along_curve<2>(mesh, surface.points.size());
    verify_cap<2>(mesh, surface);
    return mesh;
}

} // namespace

template<>
CapMesh<2> mesh_cap<2>(const Surface<2>& surface, const CapOptions& options) {
    if (options.ranks == nullptr) {
        return mesh_alone(surface, options);
    }
    return together(*options.ranks, [&] {
        return with_shared_points(options.ranks->first() ? mesh_alone(surface, options) : CapMesh<2>{},
                                  *options.ranks);
    });
}

template<>
CapMesh<2> mesh_cap<2>(const Boundary<2>&, const Surface<2>& surface, const CapOptions& options) {
    return mesh_cap<2>(surface, options);
}

} // namespace slabhull
