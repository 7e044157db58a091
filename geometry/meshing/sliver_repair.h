// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

#include <cstddef>

namespace slabhull {

/// Moves vertices, none of the first `fixed_points`, of cells whose smallest dihedral angle is below `wanted`
/// degrees, wherever that raises the smallest angle around the vertex. Cells stay what they are, and positive
/// (exactly). Cost: a pass over all cells, and some milliseconds for each cell below. Does not depend on the
/// number of threads.
void repair_slivers(CapMesh<3>& mesh, std::size_t fixed_points, double wanted);

} // namespace slabhull
