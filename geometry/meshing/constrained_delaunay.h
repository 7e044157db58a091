// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

namespace slabhull {

/// The constrained Delaunay triangulation (CGAL) of the domain that closed polygons bound: their points and
/// nothing else. Which triangles are inside follows from the orientation of the edges, every one of which is
/// heeded. Throws GeometryError naming edges or vertices: open or inconsistently oriented curves, crossing
/// edges, coincident points, points on edges, numbers that are not finite. Cost: near-linear for ordinary
/// curves.
CapMesh<2> constrained_delaunay(const Surface<2>& surface);

} // namespace slabhull
