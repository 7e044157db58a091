// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

namespace slabhull {

/// The constrained Delaunay triangulation (CGAL) of the domain bounded by closed polygons; no points are
/// added. The orientation of the edges tells which triangles are inside; every edge is used. Throws
/// GeometryError naming edges or vertices: open or inconsistently oriented curves, crossing edges, coincident
/// points, points on edges, coordinates that are not finite. Cost: near-linear for ordinary curves.
CapMesh<2> constrained_delaunay(const Surface<2>& surface);

} // namespace slabhull
