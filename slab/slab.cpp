// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slab.h"

#include "slabhull/slab/tangling.h"

namespace slabhull {

template<int D>
Slab<D> build_slab(const SpatialMesh<D>& initial, int number, std::vector<double> times,
                   const SlabSettings<D>& settings, IdCounter ids, StageClock& clock) {
    Slab<D> slab;
    Sweep<D> sweep = sweep_boundary<D>(initial, settings.motions, settings.motion_start, std::move(times),
                                       settings.trajectory);
    clock.book("trajectories");
    require_embedded_levels<D>(sweep, settings.motions, settings.motion_start, settings.trajectory);
    clock.book("boundary check");
    CapMesh<D> mesh = mesh_cap<D>(sweep.at(sweep.layers()), settings.cap);
    clock.book("cap meshing");
    IdCounter side_ids{ids.take(side_vertex_count<D>(sweep, settings.side.split))};
    slab.terminating = terminating_cap<D>(initial, sweep, std::move(mesh), ids);
    slab.hull = stitch<D>(initial, sweep, slab.terminating, settings.side, side_ids);
    slab.hull.slab = number;
    slab.projected = std::move(sweep.projected);
    slab.next_ids = ids;
    clock.book("stitching");
    return slab;
}

template Slab<2> build_slab<2>(const SpatialMesh<2>&, int, std::vector<double>, const SlabSettings<2>&,
                               IdCounter, StageClock&);
template Slab<3> build_slab<3>(const SpatialMesh<3>&, int, std::vector<double>, const SlabSettings<3>&,
                               IdCounter, StageClock&);

} // namespace slabhull
