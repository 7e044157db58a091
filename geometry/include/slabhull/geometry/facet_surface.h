// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/projection.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// A triangulated surface, for D = 2 a polyline, as a projection surface: the closest point of its facets,
/// however they meet and are oriented. Corners of facets are projected onto themselves bit for bit. Facets
/// without extent count as the edge or point that they are. Of facets that are equally near up to rounding,
/// one whose closest point is interior takes precedence, then the one of smaller number. `tolerance` is the
/// value of tolerance(). Throws UsageError if there is no facet, GeometryError naming a facet with a corner
/// that is not finite. Cost: n log n here; a closest point some log n near the surface, the usual case, and
/// up to n on the medial axis of a round one.
template<int D>
ProjectionSurfacePointer<D> facet_surface(const Surface<D>& facets, double tolerance = 0);

} // namespace slabhull
