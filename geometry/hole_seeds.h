// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/topology/spatial_mesh.h"

#include <vector>

namespace slabhull {

/// One point inside each body that a domain's boundary surrounds, well off its surface: a mesher that fills
/// closed surfaces is told by them what to leave out. Each is proven, by exact winding numbers, to be inside
/// its body and outside the domain. Needs: finite coordinates. Throws GeometryError when the surface is not
/// closed and oriented, or no such point is found.
std::vector<Point<3>> hole_seeds(const Surface<3>& surface);

} // namespace slabhull
