// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/projection.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// A surface of triangles, for D = 2 a polyline, as a projection surface: the closest point of its facets,
/// however they meet and are oriented. Corners of facets stay bit for bit. Facets without extent are taken
/// for the edge or point that they are. Of facets that are equally near up to rounding the one counts that
/// has its closest point inside rather than on its rim, then the one of smaller number. `tolerance` is what
/// tolerance() will say. Throws UsageError when there is no facet, GeometryError naming a facet with a corner
/// that is not finite. Cost: n log n here; a closest point takes some log n near the surface, where it is
/// needed, up to n on the medial axis of a round one.
template<int D>
ProjectionSurfacePointer<D> facet_surface(const Surface<D>& facets, double tolerance = 0);

} // namespace slabhull
