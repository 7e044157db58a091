// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/slab/domain.h"
#include "slabhull/topology/spatial_mesh.h"

#include <utility>

namespace slabhull {

/// The boundary of the domain that is the outer boundary without the bodies, each checked by itself.
/// Warnings: what readers did, facets that had to be turned, names of a file's parts that are not kept, one
/// name for several bodies, bodies that are dots in their box. Throws InputError naming file and facets.
/// `naming` becomes that of the whole: the files, and each facet's number in its own.
template<int D>
Surface<D> boundary_of_bodies(const InitialBodies& bodies, const Listener& listener, FacetNaming& naming);

/// A domain with this boundary, as far as the boundary goes: facets, patches and tracks are what
/// make_domain() will give them; there are no cells and no points inside.
template<int D>
SpatialMesh<D> boundary_alone(Surface<D> surface) {
    CapMesh<D> without_cells;
    without_cells.points = surface.points;
    return make_domain<D>(std::move(without_cells), std::move(surface)).mesh;
}

} // namespace slabhull
