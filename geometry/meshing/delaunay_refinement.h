// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/cap_spacing.h"

#include "slabhull/geometry/cap_mesher.h"

namespace slabhull {

/// Delaunay refinement that never splits a boundary edge: adds interior points to a constrained Delaunay
/// triangulation until its triangles are as small as `field` wants and no angle is below `min_angle` degrees
/// (at most 30), as far as possible with points not too near to boundary edges.
///
/// Points are placed in front of edges that already have the wanted length, at most as far as the
/// circumcentre, so that they form nearly equilateral triangles ("frontal", after S. Rebay 1993); then
/// circumcentres and off-centres (A. Uengoer 2004) remove small angles. Where a boundary edge forbids both,
/// the best of a few other points is taken. Needs: positive cells, constrained Delaunay, whose boundary edges
/// (without neighbor) are all the constraints. The result is constrained Delaunay again; new points follow
/// the present ones. Deterministic. Terminates on any input: a new edge is never shorter than the shortest
/// present one or 0.3 times the least spacing.
void refine_delaunay(CapMesh<2>& mesh, const CapSpacing& field, double min_angle);

} // namespace slabhull
