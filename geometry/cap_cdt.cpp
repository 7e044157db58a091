// SPDX-License-Identifier: BSD-3-Clause
#include "cap_spacing.h"
#include "constrained_delaunay.h"
#include "delaunay_refinement.h"
#include "mesh_order.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace slabhull {

namespace {

/// A tiny edge and no growth would ask for triangles until the memory is full.
void require_countable(const SizeField<2>& field) {
    const double wanted = field.cube_count() * 4 / std::numbers::sqrt3;
    if (!(wanted < static_cast<double>(no_index))) {
        throw LimitError{
            fmt::format("the spacing of the boundary and its growth ask for about {:.2g} triangles; allow "
                        "a larger growth or remove the shortest edges",
                        wanted)};
    }
}

} // namespace

template<>
CapMesh<2> mesh_cap<2>(const Surface<2>& surface, const CapOptions& options) {
    CapMesh<2> mesh = constrained_delaunay(surface);
    const CapSpacing field{surface, options.grading};
    require_countable(field.wanted());
    refine_delaunay(mesh, field, options.min_angle);

    if (options.along_curve) {
        order_along_curve(mesh, surface.points.size());
    }
    verify_cap<2>(mesh, surface);
    return mesh;
}

} // namespace slabhull
