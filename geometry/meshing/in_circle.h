// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/triangle_shape.h"

namespace slabhull::exact {

/// Whether p is strictly inside the circumcircle of a positively oriented triangle. Exact (CGAL).
bool in_circle(const plane::Corners& triangle, const Point<2>& p);

} // namespace slabhull::exact
