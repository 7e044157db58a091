// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

namespace slabhull {

/// Meshes a domain in several blocks and in ranks (CapOptions::ranks). The first rank cuts the domain; block
/// b is meshed by rank b modulo their number. Each rank gets all points and a range of the cells, ranges
/// ascending with ranks, of about equal lengths. Together they are what mesh_cap() gives in one process with
/// as many blocks; blocks are verified before they are joined. Collective, within together(). Cost: each rank
/// for its own cells, and for all points; slivers are repaired by the first.
CapMesh<3> mesh_in_ranks(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options);

} // namespace slabhull
