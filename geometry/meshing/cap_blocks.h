// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

namespace slabhull {

inline constexpr int most_blocks = 4096;

/// The wanted spacing inside a surface. Tells how much work is expected, too.
SizeField<3> wanted_size(const Surface<3>& surface, const CapOptions& options);

/// Meshes a domain with the mesher and number of blocks given by `options` (see cut_domain()). Each block has
/// its own process; as many run at once as there are threads and memory allows. The result is in the order of
/// the blocks. `options.blocks` of 0: one block if its memory is available, else 2, 4, 8 ..., so that two at
/// once fit. Needs: the boundary of a domain, see require_domain_boundary().
CapMesh<3> mesh_in_blocks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options);

/// Number of blocks for so many cells if this much memory may be used: 1, or 2, 4, 8 ...
int blocks_that_fit(SolidMesher mesher, double cells, double bytes);

} // namespace slabhull
