// SPDX-License-Identifier: BSD-3-Clause
// Parts of order_along_curve() that the order in ranks uses, too.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/spatial_mesh.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// The numbers of the points, the first `fixed` as they are and the others along the curve through all.
template<int D>
Array<Index> point_order(std::span<const Point<D>> points, std::size_t fixed);

/// From old numbers to new ones.
Array<Index> inverse_order(const Array<Index>& order);

/// Where a cell is on the curve.
template<int D>
Point<D> centre_of_cell(const Simplex<D>& cell, std::span<const Point<D>> points);

} // namespace slabhull
