// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/topology/boundary.h"
#include "slabhull/topology/spatial_mesh.h"

#include <cstddef>
#include <string>
#include <vector>

namespace slabhull {

/// Two facets of a surface that meet outside their shared vertices and edges; or one facet without extent (a
/// segment of length 0, a triangle with collinear corners, a coordinate that is not finite), which is both.
template<int D>
struct Crossing {
    Index first = no_index;
    Index second = no_index; ///< first <= second
    Point<D> near{};         ///< a point close to where they meet
};

/// All pairs of crossing facets, sorted; decided exactly. D = 2: segments, D = 3: triangles. If there are
/// more than `limit`, some of them. Touching, overlapping and folded pairs (two facets on the same side of
/// a shared edge) count. Coincident vertices with different numbers count as touching. A facet without extent
/// is paired with itself only.
/// Needs: facets that refer to points of the surface.
/// Cost: near-linear for facets of any sizes whose boxes meet few others; 1.5 million triangles/s on one
/// thread.
/// The result does not depend on the number of threads.
template<int D>
std::vector<Crossing<D>> find_crossings(const Surface<D>& surface, std::size_t limit = 100);

/// Names of facets in messages.
struct FacetNaming {
    std::string where;                 ///< prefix, such as "room.msh" or "at t = 0.25"
    std::vector<std::int64_t> numbers; ///< the user's number of each facet; empty: counted from 0
};

/// Throws unless `surface` bounds a domain: finite coordinates, every vertex used, every ridge in exactly
/// two facets of opposite orientation, one fan of facets at each vertex, no crossing facets, and components
/// nested so that the domain lies on the inner side of every one (a body outside the box is refused).
/// The error is a GeometryError, or an InputError when `is_input`; it names facets by number and patch.
/// Cost: that of find_crossings() and of adjacency; nesting adds one ray per component.
template<int D>
void require_domain_boundary(const Surface<D>& surface, const FacetNaming& naming, bool is_input);

/// The same for a boundary with the positions of `surface`: connectivity is known, so only positions are
/// checked.
/// Throws GeometryError. Cost: that of find_crossings().
template<int D>
void require_domain_boundary(const Boundary<D>& boundary, const Surface<D>& surface,
                             const FacetNaming& naming = {});

} // namespace slabhull
