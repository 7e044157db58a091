// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/findings.h"
#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

/// The facets in one simplex only, outward, and that simplex of each.
template<int D>
struct OpenFacets {
    std::span<const Simplex<D>> facets;
    std::span<const Index> cells;
};

/// Whether the star of each vertex covers its surroundings once: a whole ball at an inner vertex; at a
/// boundary vertex, the part of a ball on one side of the boundary facets.
///
/// From each vertex a ray is cast into one of its simplices; at a boundary vertex, close beside a boundary
/// facet. By exact sign it must be inside no other simplex at the vertex. If all simplices at an inner vertex
/// are positive and paired across their facets, its link covers every direction equally often. So one
/// direction covered once proves all: the link is mapped one to one to the sphere of directions. At a
/// boundary vertex, the number of covers changes only across the boundary, by one. If the boundary around the
/// vertex is embedded, one cover beside a facet excludes two anywhere. The link is then the part of the
/// sphere of directions that the boundary cuts off: a ball.
///
/// Needs: simplices that are positive and paired. Cost: linear.
template<int D>
void check_links(std::span<const Point<D + 1>> points, std::span<const Simplex<D + 1>> cells,
                 const OpenFacets<D>& open, Findings& findings);

/// Whether the boundary is a closed manifold, by its links. Needs: cells that are paired.
template<int D>
void check_boundary(std::size_t vertex_count, std::span<const Simplex<D>> facets, Findings& findings);

} // namespace slabhull
