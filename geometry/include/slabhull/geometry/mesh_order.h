// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// Renumbers the points after the first `fixed_points`, and all cells by their centres, along a Z curve
/// (Morton order), so that points near in space are mostly near in memory. Cells keep the order of their
/// corners; neighbours follow. What lies on one place of the curve, of 2^(64 / D) per axis, keeps its order.
/// Cost: a sort, some 24 extra bytes for each cell.
template<int D>
void order_along_curve(CapMesh<D>& mesh, std::size_t fixed_points);

/// The numbers of points in their order along that curve.
template<int D>
Array<Index> curve_order(std::span<const Point<D>> points);

} // namespace slabhull
