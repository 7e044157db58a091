// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/findings.h"
#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

/// A facet in one simplex, outward, and that simplex.
template<int D>
struct OpenFacets {
    std::span<const Simplex<D>> facets;
    std::span<const Index> cells;
};

/// Whether the simplices at each vertex lie around it once: as a ball inside, on the boundary as a part of
/// one that lies on one side of the boundary's facets there.
///
/// From each vertex a ray is sent into one of its simplices, on the boundary close beside a boundary facet.
/// It must be strictly inside no other simplex at the vertex, by exact sign. Where all simplices at an inner
/// vertex are positive and paired across their facets, its link is mapped to the sphere of directions, and
/// each direction is met equally often. So once for one is once for all: the map is one to one, and the link
/// a sphere. At a vertex of the boundary the number of times changes by one across the boundary only; beside
/// a facet once means nowhere twice if the boundary around the vertex is embedded. The link then is what the
/// boundary, a sphere of directions, cuts off: a ball.
///
/// Needs: simplices that are positive and paired. Cost: linear.
template<int D>
void check_links(std::span<const Point<D + 1>> points, std::span<const Simplex<D + 1>> cells,
                 const OpenFacets<D>& open, Findings& findings);

/// Whether the boundary is a closed manifold, by its links. Needs: cells that are paired.
template<int D>
void check_boundary(std::size_t vertex_count, std::span<const Simplex<D>> facets, Findings& findings);

} // namespace slabhull
