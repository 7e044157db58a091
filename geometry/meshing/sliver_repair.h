// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

#include <cstddef>
#include <vector>

namespace slabhull {

/// Moves vertices, except the first `fixed_points`, of cells whose smallest dihedral angle is below `wanted`
/// degrees, if that increases the smallest angle around the vertex. Connectivity is unchanged, and cells stay
/// positive (exactly). Cost: a pass over all cells, and some milliseconds for each cell below `wanted`. Does
/// not depend on the number of threads.
void repair_slivers(CapMesh<3>& mesh, std::size_t fixed_points, double wanted);

/// The cells whose smallest dihedral angle is below `wanted` degrees, ascending.
std::vector<Index> find_slivers(const CapMesh<3>& mesh, double wanted);

} // namespace slabhull
