// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sweep.h"

#include "slab/sweep/boundary_mover.h"
#include "slab/sweep/sweep_start.h"

#include "slabhull/core/vector.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

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

/// Looks for the vertex that is farthest from where the motions have it.
template<int D>
class CourseCheck {
public:
    CourseCheck(const Boundary<D>& boundary, const SpatialMesh<D>& cap, const PatchMotions<D>& motions,
                double motion_start, double time)
        : boundary_{boundary}, cap_{cap}, motions_{motions}, motion_start_{motion_start}, time_{time} {
        constexpr double rounding = 1e-6;
        const Sweep<D> here = started_sweep(boundary, cap, {time});
        allowed_ = std::max(rounding * extent_of<D>(here.positions.front()),
                            uncertainty(motions, motion_start, time));
    }

    std::optional<OffCourse> run() {
        for (const auto& [patch, moving] : motions_) {
            if (moving.surface != nullptr) {
                look_at_surface(patch, moving);
            }
        }
        for (const auto& [patch, moving] : motions_) {
            if (moving.surface == nullptr && moving.nodal != nullptr) {
                look_at_places(patch, moving);
            }
        }
        return farthest_;
    }

private:
    void look_at_surface(PatchNumber patch, const MovingPatch<D>& moving) {
        const std::vector<Index> vertices = boundary_.vertices_of({patch});
        std::vector<Point<D>> places;
        for (const Index v : vertices) {
            places.push_back(place_of(v));
            projected_.insert(v);
        }
        std::vector<double> off(places.size());
        project<D>(*moving.surface, surface_placement(moving, motion_start_, time_), places, off);
        for (std::size_t i = 0; i < off.size(); ++i) {
            keep({patch, boundary_.mesh_vertices()[vertices[i]], off[i], true});
        }
    }

    /// Without the vertices that are projected onto the surface of another patch afterwards.
    void look_at_places(PatchNumber patch, const MovingPatch<D>& moving) {
        const std::vector<Index> vertices = boundary_.vertices_of({patch});
        std::vector<Point<D>> wanted(vertices.size());
        moving.nodal->positions(tracks_of<D>(boundary_, vertices), time_, wanted);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (!projected_.contains(vertices[i])) {
                keep({patch, boundary_.mesh_vertices()[vertices[i]],
                      distance(wanted[i], place_of(vertices[i])), false});
            }
        }
    }

    const Point<D>& place_of(Index vertex) const { return cap_.points[boundary_.mesh_vertices()[vertex]]; }

    void keep(const OffCourse& off) {
        if (off.distance > (farthest_ ? farthest_->distance : allowed_)) {
            farthest_ = off;
        }
    }

    const Boundary<D>& boundary_;
    const SpatialMesh<D>& cap_;
    const PatchMotions<D>& motions_;
    double motion_start_;
    double time_;
    double allowed_ = 0;
    std::set<Index> projected_;
    std::optional<OffCourse> farthest_;
};

} // namespace

template<int D>
std::optional<OffCourse> farthest_off_course(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                             const PatchMotions<D>& motions, double motion_start,
                                             double time) {
    return CourseCheck<D>{boundary, cap, motions, motion_start, time}.run();
}

template struct Sweep<2>;
template struct Sweep<3>;
template Sweep<2> sweep_boundary<2>(const Boundary<2>&, const SpatialMesh<2>&, const PatchMotions<2>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template Sweep<3> sweep_boundary<3>(const Boundary<3>&, const SpatialMesh<3>&, const PatchMotions<3>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template std::optional<OffCourse> farthest_off_course<2>(const Boundary<2>&, const SpatialMesh<2>&,
                                                         const PatchMotions<2>&, double, double);
template std::optional<OffCourse> farthest_off_course<3>(const Boundary<3>&, const SpatialMesh<3>&,
                                                         const PatchMotions<3>&, double, double);

} // namespace slabhull
