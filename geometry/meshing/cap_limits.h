// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/boundary.h"
#include "slabhull/topology/spatial_mesh.h"

#include <span>

namespace slabhull {

/// Cells of a cap per cube (square) of the wanted spacing.
template<int D>
inline constexpr double cells_per_cube = D == 3 ? 7.2 : 2.3;

/// Cells of a cap if the domain filled the box around its boundary, which is at `places`: more than there
/// will be. Cost: that of a SizeField.
template<int D>
double most_cap_cells(const Boundary<D>& boundary, std::span<const Point<D>> places, const Grading& grading);

/// Throws LimitError, with the figures, if filling the domain with cells no longer than `largest` needs more
/// cells than indices can count or free memory can hold; nothing of that size is allocated. `key`: what the
/// user calls `largest`. Cost: linear in the facets.
template<int D>
void require_attainable(const Surface<D>& surface, double largest, const char* key = "cap.size");

/// Throws GeometryError naming two points of the boundary, with their patches, that TetGen would merge:
/// nearer than 1e-8 of the diagonal of the bounding box. Cost: that of sorting the points.
void require_resolvable(const Surface<3>& surface);

} // namespace slabhull
