// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"
#include "slabhull/slab/stage_clock.h"
#include "slabhull/slab/stitch.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// The mesh that a march starts from, as the case says: read from a file, or made from surfaces or curves.
/// Boundary facets are sorted by patch; boundary vertices get tracks from 0 in the order of the vertices, all
/// vertices get ids. Throws InputError for files that do not hold a valid domain, naming file and entities;
/// GeometryError when meshing the first cap fails.
template<int D>
SpatialMesh<D> initial_cap(const Case& the_case, IdCounter& ids, const Listener& listener, StageClock& clock);

} // namespace slabhull
