// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/spatial_mesh.h"

#include <span>
#include <vector>

namespace slabhull {

/// Divides a closed surface along its edges, close to a plane: for each facet, whether it counts as above.
/// The edges between the two sides are the shortest, in spacings, that facets near the plane allow (a minimum
/// cut of their dual graph). So they run straight and avoid features that the plane would barely touch.
/// `height`: of each vertex above the plane; `spacing`: of the mesh there. `neighbors`: the facets across the
/// edges of each. Cost: near-linear in the facets near the plane, plus a pass over all.
/// pass over all.
std::vector<char> divide_surface(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                                 std::span<const double> height, std::span<const double> spacing);

/// The edges between facets below and facets above, oriented as in the facet below.
Array<Facet<2>> edges_between(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                              const std::vector<char>& above);

} // namespace slabhull
