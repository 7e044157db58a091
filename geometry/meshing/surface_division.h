// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/spatial_mesh.h"

#include <span>
#include <vector>

namespace slabhull {

/// Divides a closed surface along its edges, close to a plane: whether each facet counts as above it. The
/// edges between the two sides are the shortest, in spacings, that facets near the plane allow (a minimum cut
/// of their dual graph), so they run straight and leave out what a plane would but scratch.
/// `height` is that of each vertex above the plane, `spacing` that of the mesh there.
/// `neighbors` are the facets across the edges of each. Cost: near-linear in the facets near the plane; a
/// pass over all.
std::vector<char> divide_surface(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                                 std::span<const double> height, std::span<const double> spacing);

/// The edges of facets below to facets above, each as it runs in the facet below.
Array<Facet<2>> edges_between(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                              const std::vector<char>& above);

} // namespace slabhull
