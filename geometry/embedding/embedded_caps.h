// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/adjacency.h"

#include <span>

namespace slabhull {

/// Which cap a hull cell is in, by the times of its vertices.
enum class CapOf : unsigned char { none, first, last };

/// The cap of each cell: all its vertices are at the earliest or at the latest time of the hull.
template<int D>
Array<CapOf> find_caps(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells);

/// Whether neither cap crosses itself or a cell of the side, proven without testing pairs of cells:
///
/// - Every facet of the hull is in two cells of opposite induced orientation, the cells of a cap all have the
///   same sign, and their boundary bounds a domain (no crossings, properly nested). The number of cells over
///   a generic point is then the winding number of that boundary, 0 or 1: no two cells overlap. Nor do they
///   touch outside common faces: at an inner vertex, edge or facet the cells around it fill a neighbourhood,
///   which leaves no room for another, and boundary facets do not touch each other.
/// - A side cell meets the cap's time in the face of its vertices at that time. Each such face is in the
///   cap's boundary, so it meets the cap's cells in common faces only.
///
/// False only says that this proof fails. Cost: that of require_domain_boundary() for both caps.
template<int D>
bool caps_are_embedded(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const AdjacencyView<D>& adjacency, std::span<const CapOf> caps);

} // namespace slabhull
