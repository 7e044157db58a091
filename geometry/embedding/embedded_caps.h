// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/topology/adjacency.h"

#include <span>
#include <vector>

namespace slabhull {

/// Where a cell of a hull is, by the times of its vertices.
enum class CapOf : unsigned char { none, first, last };

/// For each cell, the cap that it is in: all its vertices at the first or at the last time of all.
template<int D>
std::vector<CapOf> find_caps(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells);

/// Whether neither cap crosses itself or a cell of the side, shown without testing their cells in pairs:
///
/// - Every facet of the hull is in two cells of opposite induced orientation, the cells of a cap all have the
///   same sign, and the facets around it bound a domain (no crossings, properly nested). The number of cells
///   over a generic place is then the winding number of that boundary, 0 or 1: no two cells overlap. Nor do
///   they touch off their common faces: at an inner vertex, edge or facet the cells around it fill a
///   neighbourhood, which leaves no room for another, and boundary facets do not touch each other.
/// - What a side cell has at the cap's time is the face of its vertices at that time. Each such face is one
/// of
///   the cap's boundary, so what it has in common with the cap's cells are common faces.
///
/// False says only that this proof fails. Cost: that of require_domain_boundary() for both caps.
template<int D>
bool caps_are_embedded(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const AdjacencyView<D>& adjacency, std::span<const CapOf> caps);

} // namespace slabhull
