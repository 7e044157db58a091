// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/size_field.h"

namespace slabhull {

inline constexpr int most_blocks = 4096;

/// Meshes a domain by the mesher that `options` names, in as many blocks as they ask for (see cut_domain()),
/// each in a process of its own, as many at once as there are threads and memory allows, and joins them in
/// the order of the blocks. `options.blocks` of 0: one block if the mesher's memory is there, else 2, 4, 8
/// ..., so that two at once fit. Needs: the boundary of a domain, see require_domain_boundary().
CapMesh<3> mesh_in_blocks(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                          const CapOptions& options);

/// How many blocks so many cells are meshed in when so much memory may be used: 1, or 2, 4, 8 ...
int blocks_that_fit(SolidMesher mesher, double cells, double bytes);

} // namespace slabhull
