// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/geometry/motion.h"
#include "slabhull/geometry/nodal_motion.h"
#include "slabhull/geometry/projection.h"
#include "slabhull/geometry/stretch.h"
#include "slabhull/geometry/trajectory.h"
#include "slabhull/topology/boundary.h"
#include "slabhull/topology/spatial_mesh.h"

#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

namespace slabhull {

/// The motion of a patch, one of three: a field in space, a motion of each track, or stretching between its
/// neighbours. Its vertices are then projected onto its surface, if it has one.
template<int D>
struct MovingPatch {
    MotionPointer<D> motion;
    /// Moves with the motion, which must have a closed form; stands still when the patch stretches.
    ProjectionSurfacePointer<D> surface = nullptr;
    NodalMotionPointer<D> nodal = nullptr;
    StretchPointer<D> stretch = nullptr; ///< one for all patches that stretch
};

/// The moving patches by number; a patch that is not listed stands still.
template<int D>
using PatchMotions = std::map<PatchNumber, MovingPatch<D>>;

/// The boundary of the domain on every level of a slab: step 3 of the method. In ranks each has the first
/// level, the last and some between.
template<int D>
struct Sweep {
    Boundary<D> boundary;                   ///< what is swept; it bounds the initial cap
    std::vector<double> times;              ///< of the levels, ascending
    std::vector<Array<Point<D>>> positions; ///< by level, then by vertex of the boundary; empty: not here
    std::map<PatchNumber, ProjectionReport>
        projected; ///< how far projection moved each patch, over all levels

    std::size_t layers() const { return times.size() - 1; }
    /// Whether a level is here.
    bool has(std::size_t level) const { return !positions[level].empty(); }
    /// The places on a level. Throws std::logic_error if it is not here.
    const Array<Point<D>>& places(std::size_t level) const {
        if (!has(level)) {
            throw std::logic_error{"a level is asked for that is on other ranks only"};
        }
        return positions[level];
    }
    /// Gives a level up, and its memory.
    void release(std::size_t level) {
        Array<Point<D>>{}.swap(positions[level]); // assigning {} would keep the memory
    }
    /// The surface at a level. Throws as places() does.
    Surface<D> at(std::size_t level) const;
};

/// Sweeps `boundary` from its places in `cap`, which it bounds, through the levels `times`. `motion_start` is
/// the time at which projection surfaces are given; the motion takes them from there to each level. A vertex
/// shared by patches follows all their motions, which must agree there, and is projected onto all their
/// surfaces. Throws GeometryError naming the patches and the vertices where motions disagree, and the
/// vertices that projection would move by more than half of their shortest edge.
template<int D>
Sweep<D> sweep_boundary(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                        const PatchMotions<D>& motions, double motion_start, std::vector<double> times,
                        const TrajectoryOptions& options);

/// A vertex that is not where the motions have it.
struct OffCourse {
    PatchNumber patch = 0;
    Index vertex = 0; ///< of the cap
    double distance = 0;
    bool off_surface = false; ///< of its patch; else off the place that a motion of vertices gives
};

/// The vertex of `boundary`, at its place in `cap`, that is farthest off the projection surface of its patch,
/// where the motion has taken that by `time`, or off its place by the patch's nodal motion; none where all
/// are there, up to the surfaces' tolerances and 1e-6 of the extent. After a slab none is, unless the motion
/// or the surface was changed meanwhile. Throws as nodal motions do.
template<int D>
std::optional<OffCourse> farthest_off_course(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                             const PatchMotions<D>& motions, double motion_start,
                                             double time);

} // namespace slabhull
