// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sweep.h"

#include "slab/sweep/boundary_mover.h"
#include "slab/sweep/sweep_start.h"

#include <utility>

namespace slabhull {

template<int D>
Surface<D> Sweep<D>::at(std::size_t level) const {
    return boundary.at(places(level));
}

template<int D>
Sweep<D> sweep_boundary(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                        const PatchMotions<D>& motions, double motion_start, std::vector<double> times,
                        const TrajectoryOptions& options) {
    Sweep<D> sweep = started_sweep(boundary, cap, std::move(times));
    BoundaryMover<D> mover{sweep, motions, motion_start, options};
    for (std::size_t level = 1; level < sweep.times.size(); ++level) {
        sweep.positions.push_back(
            mover.move(sweep.positions.back(), sweep.times[level - 1], sweep.times[level]));
    }
    sweep.projected = mover.projected();
    return sweep;
}

template struct Sweep<2>;
template struct Sweep<3>;
template Sweep<2> sweep_boundary<2>(const Boundary<2>&, const SpatialMesh<2>&, const PatchMotions<2>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template Sweep<3> sweep_boundary<3>(const Boundary<3>&, const SpatialMesh<3>&, const PatchMotions<3>&, double,
                                    std::vector<double>, const TrajectoryOptions&);

} // namespace slabhull
