// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/point.h"

namespace slabhull {

/// Whether two tetrahedra in R^4 are proven to have nothing in common but the face of the vertices they
/// share. False says only that floating point found no proof: common_point() decides then.
///
/// Needs: non-degenerate tetrahedra with at most three vertices in common. The proof is a hyperplane that
/// contains the shared vertices and has the other vertices of the two strictly on different sides. One exists
/// whenever the pair is apart: seen from the shared face the two are pointed convex cones that meet in their
/// tip only, or, when they share no vertex, disjoint convex sets. So near misses and pairs that lie in one
/// hyperplane need no special treatment. `scale` holds a power of two for each axis, one over the usual size
/// of a cell along it; it only steers the search.
bool proven_apart(const FacetPair<4>& pair, const Point<4>& scale);

} // namespace slabhull
