// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/adapt.h"
#include "slabhull/slab/cap_reuse.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/slab/layers.h"
#include "slabhull/slab/stage_clock.h"
#include "slabhull/slab/stitch.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/hull.h"

#include <map>
#include <optional>
#include <vector>

namespace slabhull {

class Communicator;

/// What all slabs of a march share.
template<int D>
struct SlabSettings {
    PatchMotions<D> motions;
    double motion_start = 0; ///< time at which projection surfaces are given
    TrajectoryOptions trajectory;
    LayerOptions layers;
    SideOptions side{D == 3 ? Split::C : Split::centre};
    CapOptions cap;
    CapReuse reuse = CapReuse::none;
    double reuse_angle = 5; ///< degrees: a moved cap with a smaller angle is meshed anew
    AdaptOptions adapt;     ///< of CapReuse::adapt
    /// Ranks that build each slab together, all with the same settings and times: each stitches its part of
    /// the hull (Slab::part). nullptr: this process alone, the whole hull. Not with CapReuse::adapt.
    Communicator* ranks = nullptr;
};

/// One slab: its hull, which ends with the cap that the next one starts from.
template<int D>
struct Slab {
    Hull<D> hull;
    Array<Facet<D>> terminating_facets; ///< boundary of the terminating cap, in the cap's own numbers
    std::map<PatchNumber, ProjectionReport> projected;
    bool cap_moved = false; ///< the terminating cap is the initial one, moved; else meshed anew ...
    std::optional<double> moved_angle;        ///< ... its smallest angle (degrees) after moving, if tried
    int cap_blocks = 1;                       ///< number of blocks if the cap was meshed
    std::optional<Adaptation<D>> adapted;     ///< what was done to the cap with CapReuse::adapt
    std::optional<Boundary<D>> boundary;      ///< of the terminating cap, if its connectivity was changed
    LayerFit layers;                          ///< how well they follow the motion ...
    std::optional<std::size_t> layers_enough; ///< ... and a sufficient number if too few were given
    IdCounter next_ids;                       ///< the next slab's new ids start here

    /// In ranks: this rank's part of the hull, and the terminating cap without its cells, which are in the
    /// parts. `hull` then has the order of the whole only.
    std::optional<HullPart<D>> part;
    std::optional<SpatialMesh<D>> cap;

    std::size_t hull_cells() const { return part ? part->hull_cells : hull.cells.size(); }
    std::size_t hull_points() const { return part ? part->hull_points() : hull.points.size(); }
    /// A copy of the terminating cap.
    SpatialMesh<D> terminating() const {
        return cap ? *cap : terminating_cap_of<D>(hull, terminating_facets);
    }
};

/// What a slab needs of its boundary alone: the swept boundary, and a terminating cap meshed anew.
template<int D>
struct PreparedSlab {
    Sweep<D> sweep;
    LayerFit layers;                          ///< as in Slab
    std::optional<std::size_t> layers_enough; ///< as in Slab
    CapMesh<D> cap;
    StageClock clock; ///< what it took
};

/// Sweeps the boundary from its places in `cap`, whose cells are not asked, and checks it on every level. The
/// cap is still to be meshed. Throws as build_slab() does.
template<int D>
PreparedSlab<D> sweep_ahead(const Boundary<D>& boundary, const SpatialMesh<D>& cap, std::vector<double> times,
                            const SlabSettings<D>& settings);

/// Meshes the cap of a slab whose boundary is swept. Throws as mesh_cap() does.
template<int D>
void mesh_ahead(PreparedSlab<D>& prepared, const CapOptions& options);

/// Builds slab `number` on the initial cap, which `boundary` bounds, by the seven steps of the method.
/// `times` are the levels, or start and end if layers follow from the motion (LayerOptions::automatic). The
/// hull is not checked as a whole (check_hull() does); the boundary is, on every level, and so is the
/// terminating cap. New ids are counted from `ids`: first the side's, then those of the terminating boundary,
/// then those inside the cap. Throws GeometryError naming what and where: motions that disagree, a cap that
/// cannot be meshed; TangledBoundary for a boundary that crosses itself or leaves its box. If an error is
/// thrown, an initial cap to be given up is still intact.
template<int D>
Slab<D> build_slab(CapToStitch<D> initial, const Boundary<D>& boundary, int number, std::vector<double> times,
                   const SlabSettings<D>& settings, IdCounter ids, StageClock& clock);

/// The same, of a slab that was prepared for the same boundary and settings: the result is the same, bit for
/// bit.
template<int D>
Slab<D> build_slab(CapToStitch<D> initial, const Boundary<D>& boundary, int number, PreparedSlab<D> prepared,
                   const SlabSettings<D>& settings, IdCounter ids, StageClock& clock);

} // namespace slabhull
