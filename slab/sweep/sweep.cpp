// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sweep.h"

#include "slab/sweep/boundary_mover.h"
#include "slab/sweep/sweep_start.h"

#include <algorithm>
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

namespace {

/// What the surfaces themselves leave open, where patches that share a vertex meet.
template<int D>
double uncertainty(const PatchMotions<D>& motions, double motion_start, double time) {
    double sum = 0;
    for (const auto& [patch, moving] : motions) {
        if (moving.surface != nullptr) {
            sum += surface_placement(moving, motion_start, time).scale() * moving.surface->tolerance();
        }
    }
    return sum;
}

} // namespace

template<int D>
std::optional<OffSurface> farthest_off_surface(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                               const PatchMotions<D>& motions, double motion_start,
                                               double time) {
    constexpr double rounding = 1e-6;
    const Sweep<D> here = started_sweep(boundary, cap, {time});
    OffSurface worst{
        0, 0,
        std::max(rounding * extent_of<D>(here.positions.front()), uncertainty(motions, motion_start, time))};
    std::optional<OffSurface> found;
    for (const auto& [patch, moving] : motions) {
        if (moving.surface == nullptr) {
            continue;
        }
        const std::vector<Index> vertices = boundary.vertices_of({patch});
        std::vector<Point<D>> places;
        for (const Index v : vertices) {
            places.push_back(here.positions.front()[v]);
        }
        std::vector<double> off(places.size());
        project<D>(*moving.surface, surface_placement(moving, motion_start, time), places, off);
        for (std::size_t i = 0; i < off.size(); ++i) {
            if (off[i] > worst.distance) {
                worst = {patch, boundary.mesh_vertices()[vertices[i]], off[i]};
                found = worst;
            }
        }
    }
    return found;
}

template struct Sweep<2>;
template struct Sweep<3>;
template Sweep<2> sweep_boundary<2>(const Boundary<2>&, const SpatialMesh<2>&, const PatchMotions<2>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template Sweep<3> sweep_boundary<3>(const Boundary<3>&, const SpatialMesh<3>&, const PatchMotions<3>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template std::optional<OffSurface> farthest_off_surface<2>(const Boundary<2>&, const SpatialMesh<2>&,
                                                           const PatchMotions<2>&, double, double);
template std::optional<OffSurface> farthest_off_surface<3>(const Boundary<3>&, const SpatialMesh<3>&,
                                                           const PatchMotions<3>&, double, double);

} // namespace slabhull
