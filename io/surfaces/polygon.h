// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <span>
#include <vector>

namespace slabhull::io {

/// Why a polygon cannot be cut into triangles.
enum class PolygonFault { none, too_long, no_area, not_planar, not_simple };

/// Text that continues "face 7 has 5 vertices".
const char* explained(PolygonFault fault);

using PolygonTriangle = std::array<std::size_t, 3>; ///< corner numbers in the polygon

/// Cuts a planar polygon into triangles that keep its direction and all its vertices, straight ones included,
/// by cutting off its best-shaped ear again and again; of a quadrilateral, it takes the better diagonal. A
/// polygon is planar if it lies within 1e-6 of its largest coordinate and 1e-3 of its extent: files have six
/// digits or single precision. Quadratic in the polygon's length, which may be 10,000.
PolygonFault cut_polygon(std::span<const Point<3>> corners, std::vector<PolygonTriangle>& triangles);

} // namespace slabhull::io
