// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/embedding.h"
#include "slabhull/topology/spatial_mesh.h"

#include <cstddef>

namespace slabhull {

/// Turns the facets of a body, or of the outer boundary, so that in each connected component they agree with
/// each other and their normals leave the domain. Returns how many facets pointed into the body (the outer
/// boundary) while others of their component pointed out of it; a component that is inside out as a whole
/// counts for none. Throws InputError
/// for what has one side only, such as a Moebius band or a Klein bottle, naming two facets. What is open or
/// has facets in common ridges of three is left for require_domain_boundary(). Cost: that of the adjacency.
template<int D>
std::size_t turn_outward(Surface<D>& surface, bool encloses_domain, const FacetNaming& naming);

} // namespace slabhull
