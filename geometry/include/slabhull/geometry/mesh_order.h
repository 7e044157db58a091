// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// Sorts the points after the first `fixed_points`, and all cells by their centres, along a Z curve (Morton
/// order), so that points near in space are mostly near in memory. Cells keep the order of their corners;
/// neighbours are renumbered. Entries at the same place of the curve, of 2^(64 / D) per axis, keep their
/// order.
/// Cost: a sort, some 24 extra bytes for each cell.
template<int D>
void order_along_curve(CapMesh<D>& mesh, std::size_t fixed_points);

/// The numbers of the points in the order of that curve.
template<int D>
Array<Index> curve_order(std::span<const Point<D>> points);

} // namespace slabhull
