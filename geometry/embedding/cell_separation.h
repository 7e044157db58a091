// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/point.h"

namespace slabhull {

/// Whether two tetrahedra in R^4 are proven to meet only in the face of their shared vertices. False only
/// says that floating point found no proof: then common_point() decides.
///
/// Needs: non-degenerate tetrahedra with at most three vertices in common. The proof is a hyperplane that
/// contains the shared vertices and strictly separates the other vertices of the two. It exists whenever they
/// meet in that face only: modulo the shared face they are pointed convex cones that meet only in their apex,
/// or, without shared vertices, disjoint convex sets. So near misses and pairs in one hyperplane need no
/// special treatment. `scale`: a power of two per axis, the inverse of the usual cell size along it; it only
/// steers the search.
bool proven_apart(const FacetPair<4>& pair, const Point<4>& scale);

} // namespace slabhull
