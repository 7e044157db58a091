// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// Cells of a cap for each cube (square) of the wanted spacing.
template<int D>
inline constexpr double cells_per_cube = D == 3 ? 7.2 : 2.3;

/// Throws LimitError, with the figures, where cells no longer than `largest` throughout the domain are more
/// than indices or the memory that is free can hold, before anything is made of their size. Cost: linear in
/// the facets.
template<int D>
void require_attainable(const Surface<D>& surface, double largest);

/// Throws GeometryError naming two points of the boundary that TetGen would take for one, as nearer than 1e-8
/// of the diagonal of the box around all, with their patches. Cost: that of sorting the points.
void require_resolvable(const Surface<3>& surface);

} // namespace slabhull
