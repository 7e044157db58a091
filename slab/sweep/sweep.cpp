// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sweep.h"

#include "slab/sweep/boundary_mover.h"

#include <utility>

namespace slabhull {

template<int D>
Surface<D> Sweep<D>::at(std::size_t level) const {
    Surface<D> result = surface;
    result.points = positions[level];
    return result;
}

template<int D>
Surface<D> boundary_of(const SpatialMesh<D>& cap, Array<Index>& cap_vertex) {
    Surface<D> surface;
    surface.patch = cap.boundary_patch;
    surface.patches = cap.patches;
    std::vector<Index> compact(cap.points.size(), no_index);
    for (const auto& facet : cap.boundary_facets) {
        for (const Index v : facet) {
            compact[v] = 0;
        }
    }
    cap_vertex.clear();
    for (Index v = 0; v < compact.size(); ++v) {
        if (compact[v] == 0) {
            compact[v] = static_cast<Index>(cap_vertex.size());
            cap_vertex.push_back(v);
            surface.points.push_back(cap.points[v]);
        }
    }
    surface.facets = cap.boundary_facets;
    for (auto& facet : surface.facets) {
        for (Index& v : facet) {
            v = compact[v];
        }
    }
    return surface;
}

template<int D>
Sweep<D> sweep_boundary(const SpatialMesh<D>& cap, const PatchMotions<D>& motions, double motion_start,
                        std::vector<double> times, const TrajectoryOptions& options) {
    Sweep<D> sweep;
    sweep.surface = boundary_of(cap, sweep.cap_vertex);
    for (const Index v : sweep.cap_vertex) {
        sweep.tracks.push_back(cap.track_ids[v]);
    }
    sweep.times = std::move(times);
    sweep.positions.push_back(sweep.surface.points);
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
template Surface<2> boundary_of<2>(const SpatialMesh<2>&, Array<Index>&);
template Surface<3> boundary_of<3>(const SpatialMesh<3>&, Array<Index>&);
template Sweep<2> sweep_boundary<2>(const SpatialMesh<2>&, const PatchMotions<2>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template Sweep<3> sweep_boundary<3>(const SpatialMesh<3>&, const PatchMotions<3>&, double,
                                    std::vector<double>, const TrajectoryOptions&);

} // namespace slabhull
