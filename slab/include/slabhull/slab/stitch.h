// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/prism_split.h"

namespace slabhull {

/// The persistent id that is given out next; a march holds one.
struct IdCounter {
    PersistentId next = 0;
    PersistentId take(std::size_t count) {
        const PersistentId first = next;
        next += static_cast<PersistentId>(count);
        return first;
    }
};

/// A terminating cap as a spatial mesh: new ids for its points, the tracks and patches of the initial one.
/// `mesh` has the sweep's vertices first, at their last positions.
template<int D>
SpatialMesh<D> terminating_cap(const SpatialMesh<D>& initial, const Sweep<D>& sweep, CapMesh<D>&& mesh,
                               IdCounter& ids);

/// Joins the initial cap, the side made from the sweep and the terminating cap into one closed hull: steps 5 to 7.
/// Vertices: those of the initial cap, then the side's by layer (levels, face centres, prism centres), then the
/// terminating cap's. Throws GeometryError when the three do not close (which the caps' own checks make impossible).
/// Cost: linear.
template<int D>
Hull<D> stitch(const SpatialMesh<D>& initial, const Sweep<D>& sweep, const SpatialMesh<D>& terminating, Split split,
               IdCounter& ids);

} // namespace slabhull
