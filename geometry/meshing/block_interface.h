// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/plane_frame.h"

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// A triangulated surface across a domain, between closed curves of edges of its boundary.
struct BlockInterface {
    Array<Point<3>> points; ///< new points, not the boundary's
    /// Normals along the plane's. Vertices below `fixed` are the boundary's; fixed + i is points[i].
    Array<Facet<3>> facets;
};

/// Spans the closed curves of `rim` by a surface: the planar mesher fills the curves' projections on the
/// plane with the wanted spacing; then the mesh is lifted so that it meets the curves and is smooth
/// elsewhere. Edges of the rim are not split. Throws GeometryError if the projections cross or shrink an edge
/// to less than a third.
BlockInterface span_curves(const Array<Point<3>>& points, const Array<Facet<2>>& rim, const PlaneFrame& plane,
                           const SizeField<3>& size, double growth);

} // namespace slabhull
