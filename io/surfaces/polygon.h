// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <span>
#include <vector>

namespace slabhull::io {

/// Why a polygon is not made of triangles.
enum class PolygonFault { none, too_long, no_area, not_planar, not_simple };

/// In words that go on after "face 7 has 5 vertices".
const char* explained(PolygonFault fault);

using PolygonTriangle = std::array<std::size_t, 3>; ///< places in the polygon

/// Cuts a planar polygon into triangles that keep its direction and all its vertices, straight ones included,
/// by cutting off its best-shaped ear again and again; of a quadrilateral, it takes the better diagonal.
/// Planar is what lies within 1e-6 of its largest coordinate and 1e-3 of its extent: files have six digits or
/// single precision. Quadratic in the polygon's length, which may be 10,000.
PolygonFault cut_polygon(std::span<const Point<3>> corners, std::vector<PolygonTriangle>& triangles);

} // namespace slabhull::io
