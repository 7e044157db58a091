// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/box_tree.h"

#include "slabhull/core/point.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/spatial_mesh.h"

#include <array>

namespace slabhull {

/// Corners of a facet.
template<int D>
using FacetCorners = std::array<Point<D>, D>;

template<int D>
FacetCorners<D> corners_of_facet(const Surface<D>& surface, Index facet) {
    return corners_of<D - 1, D>(surface.facets[facet], surface.points);
}

/// Two facets whose shared vertices come first, in the same order.
template<int D>
struct FacetPair {
    FacetCorners<D> f;
    FacetCorners<D> g;
    std::size_t shared = 0;
};

template<int D>
FacetPair<D> pair_of_facets(const Surface<D>& surface, Index first, Index second);

/// Bounding boxes of the facets; empty for a facet without extent or with a coordinate that is not finite.
template<int D>
Array<Box<D>> facet_boxes(const Surface<D>& surface);

/// Whether two non-degenerate facets have a common point outside their shared vertices and edges. Exact; most
/// neighbours on a smooth or flat surface are decided by one or two orientations.
bool meet_elsewhere(const FacetPair<2>& pair);
bool meet_elsewhere(const FacetPair<3>& pair);

/// A point close to both facets, for messages: on both when they meet, to about one part in a thousand.
template<int D>
Point<D> meeting_place(const FacetPair<D>& pair);

} // namespace slabhull
