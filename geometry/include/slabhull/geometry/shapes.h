// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/spatial_mesh.h"

#include <span>

namespace slabhull {

// Pieces of which boundaries of domains are composed. All facets point outward from the domain. Vertices are
// shared by construction and numbered so that neighbours in space are mostly close in memory. Invalid
// arguments (not finite, not positive, an empty box) are a UsageError; pieces with more vertices or facets
// than an Index can count, a LimitError.

/// The outer boundary min <= x <= max, with the domain inside. An edge of length l is divided into l / size
/// parts, rounded up. The squares on the faces are cut into triangles by diagonals of alternating direction.
template<int D>
Surface<D> box_surface(const Point<D>& min, const Point<D>& max, double size, const Patch& patch);

/// A body with the domain outside: an ellipsoid, for D = 2 an ellipse, with its axes along the coordinate
/// axes, and its vertices on it to rounding. D = 2: `divisions` edges (3 or more) of nearly equal length,
/// starting at centre + (a, 0). D = 3: a geodesic icosahedron of frequency n = `divisions`, 10 n^2 + 2
/// vertices and 20 n^2 triangles. A vertex u on the unit sphere is mapped to centre + A w / |w|, w = A^(-1/2)
/// u, A = diag(semi_axes). For semi-axes (1, 3, 2) this stretches triangles by 1.73 at most and spacings
/// differ by a factor of 1.84, against 3 and 3 with x = A u. Ratios of axes above 5 or so still give uneven
/// triangles.
template<int D>
Surface<D> ellipsoid_body(const Point<D>& centre, const Point<D>& semi_axes, int divisions,
                          const Patch& patch);

/// The fewest divisions for which the edges of ellipsoid_body() are about `size` long (by perimeter or area;
/// Thomsen's approximation of the area is good to 1.1 %).
template<int D>
int ellipsoid_divisions(const Point<D>& semi_axes, double size);

/// The pieces side by side as one surface, their vertices and facets in order, nothing welded.
/// Throws UsageError when a patch number has two names, or a name two numbers.
template<int D>
Surface<D> join(std::span<const Surface<D>> pieces);

template<>
Surface<2> ellipsoid_body<2>(const Point<2>&, const Point<2>&, int, const Patch&);
template<>
Surface<3> ellipsoid_body<3>(const Point<3>&, const Point<3>&, int, const Patch&);
template<>
int ellipsoid_divisions<2>(const Point<2>&, double);
template<>
int ellipsoid_divisions<3>(const Point<3>&, double);

} // namespace slabhull
