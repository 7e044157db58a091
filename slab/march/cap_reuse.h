// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/sweep.h"

namespace slabhull {

/// A terminating cap made by moving the initial one: same cells, inner vertices led by the boundary.
template<int D>
struct ReusedCap {
    CapMesh<D> mesh;           ///< swept vertices first, as a mesher gives them; empty if not good enough
    double smallest_angle = 0; ///< degrees; 0 when a cell is inverted

    bool good() const { return !mesh.points.empty(); }
};

/// The cap moved in one step, to the last level. `angle` is the required smallest angle. Cost: that of
/// move_cap().
template<int D>
ReusedCap<D> reuse_in_one_step(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle);

/// The same, more exactly, from level to level: small steps keep better cells under large turns. Needs: all
/// levels. Cost: two or three times that of move_cap() per layer.
template<int D>
ReusedCap<D> reuse_by_levels(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle);

/// The first or, if that leaves a smaller angle and there are levels between, the second.
template<int D>
ReusedCap<D> reuse_cap(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle);

/// Tracks for all vertices of a cap to be moved: its own, and new ones for inner vertices without a track.
/// The new ones follow its largest. A cap that is meshed anew takes ids as tracks, which are larger in any
/// march.
template<int D>
Array<TrackId> tracks_throughout(const SpatialMesh<D>& cap);

/// The tracks of a moved cap, swept vertices first, from those of the initial one.
template<int D>
Array<TrackId> tracks_moved(std::span<const TrackId> tracks, const Sweep<D>& sweep);

} // namespace slabhull
