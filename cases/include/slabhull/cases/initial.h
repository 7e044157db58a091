// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"
#include "slabhull/slab/domain.h"
#include "slabhull/slab/stage_clock.h"

#include <functional>

namespace slabhull {

class Communicator;

/// The domain that a march starts from, as the case says: read from a file, or made from surfaces or curves.
/// Throws InputError for files that do not hold a valid domain, naming file and entities; GeometryError when
/// meshing the first cap fails. `on_boundary` is told, before a cap is meshed, of the boundary that the
/// domain will have: a mesh without cells, whose vertices are those of the boundary. It is not for meshes
/// from files. `ranks`: those that mesh the cap together, see CapOptions.
template<int D>
Domain<D> initial_domain(const Case& the_case, const IdCounter& ids, const Listener& listener,
                         StageClock& clock,
                         const std::function<void(const SpatialMesh<D>& boundary)>& on_boundary = {},
                         Communicator* ranks = nullptr);

/// Its mesh alone; `ids` counts on.
template<int D>
SpatialMesh<D> initial_cap(const Case& the_case, IdCounter& ids, const Listener& listener, StageClock& clock);

} // namespace slabhull
