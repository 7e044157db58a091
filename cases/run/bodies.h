// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/topology/spatial_mesh.h"

namespace slabhull {

/// The boundary of the domain that is the outer boundary without the bodies, each checked by itself.
/// Warnings: what readers did, facets that had to be turned, names of a file's parts that are not kept, one
/// name for several bodies, bodies that are dots in their box. Throws InputError naming file and facets.
/// `naming` becomes that of the whole: the files, and each facet's number in its own.
template<int D>
Surface<D> boundary_of_bodies(const InitialBodies& bodies, const Listener& listener, FacetNaming& naming);

} // namespace slabhull
