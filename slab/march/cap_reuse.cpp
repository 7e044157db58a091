// SPDX-License-Identifier: BSD-3-Clause
#include "slab/march/cap_reuse.h"

#include "slab/sweep/swept_first.h"
#include "slabhull/geometry/cap_motion.h"

#include <algorithm>
#include <span>

namespace slabhull {

namespace {

template<int D>
CapMesh<D> renumbered(const SpatialMesh<D>& cap, std::span<const Point<D>> points,
                      const std::vector<Index>& number) {
    CapMesh<D> mesh;
    mesh.points.resize(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        mesh.points[number[v]] = points[v];
    }
    mesh.cells = cap.cells;
    for (Simplex<D>& cell : mesh.cells) {
        for (Index& v : cell) {
            v = number[v];
        }
    }
    mesh.neighbors = cap.neighbors;
    return mesh;
}

/// What a cap that was moved to the last level is good for.
template<int D>
ReusedCap<D> judged(const MovedCap<D>& moved, const SpatialMesh<D>& initial, const Sweep<D>& sweep,
                    double angle) {
    ReusedCap<D> reused;
    reused.smallest_angle = moved.sound ? moved.smallest_angle : 0;
    if (moved.sound && moved.smallest_angle >= angle) {
        reused.mesh = renumbered<D>(initial, moved.points,
                                    swept_first(initial.points.size(), sweep.boundary.mesh_vertices()));
    }
    return reused;
}

} // namespace

template<int D>
ReusedCap<D> reuse_in_one_step(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle) {
    return judged<D>(
        move_cap<D>(initial.points, initial.cells, sweep.boundary.mesh_vertices(), sweep.positions.back()),
        initial, sweep, angle);
}

template<int D>
ReusedCap<D> reuse_by_levels(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle) {
    MovedCap<D> moved{initial.points, 0, true, 0};
    for (std::size_t level = 1; level <= sweep.layers() && moved.sound; ++level) {
        moved = move_cap<D>(moved.points, initial.cells, sweep.boundary.mesh_vertices(), sweep.places(level));
    }
    return judged<D>(moved, initial, sweep, angle);
}

template<int D>
ReusedCap<D> reuse_cap(const SpatialMesh<D>& initial, const Sweep<D>& sweep, double angle) {
    ReusedCap<D> reused = reuse_in_one_step<D>(initial, sweep, angle);
    if (!reused.good() && sweep.layers() > 1) {
        reused = reuse_by_levels<D>(initial, sweep, angle);
    }
    return reused;
}

template<int D>
Array<TrackId> tracks_throughout(const SpatialMesh<D>& cap) {
    Array<TrackId> tracks = cap.track_ids;
    TrackId next = no_track;
    for (const TrackId track : tracks) {
        next = std::max(next, track);
    }
    for (TrackId& track : tracks) {
        track = track == no_track ? ++next : track;
    }
    return tracks;
}

template<int D>
Array<TrackId> tracks_moved(std::span<const TrackId> tracks, const Sweep<D>& sweep) {
    const std::vector<Index> number = swept_first(tracks.size(), sweep.boundary.mesh_vertices());
    Array<TrackId> moved(tracks.size());
    for (std::size_t v = 0; v < tracks.size(); ++v) {
        moved[number[v]] = tracks[v];
    }
    return moved;
}

template Array<TrackId> tracks_throughout<2>(const SpatialMesh<2>&);
template Array<TrackId> tracks_throughout<3>(const SpatialMesh<3>&);
template Array<TrackId> tracks_moved<2>(std::span<const TrackId>, const Sweep<2>&);
template Array<TrackId> tracks_moved<3>(std::span<const TrackId>, const Sweep<3>&);
template ReusedCap<2> reuse_in_one_step<2>(const SpatialMesh<2>&, const Sweep<2>&, double);
template ReusedCap<3> reuse_in_one_step<3>(const SpatialMesh<3>&, const Sweep<3>&, double);
template ReusedCap<2> reuse_by_levels<2>(const SpatialMesh<2>&, const Sweep<2>&, double);
template ReusedCap<3> reuse_by_levels<3>(const SpatialMesh<3>&, const Sweep<3>&, double);
template ReusedCap<2> reuse_cap<2>(const SpatialMesh<2>&, const Sweep<2>&, double);
template ReusedCap<3> reuse_cap<3>(const SpatialMesh<3>&, const Sweep<3>&, double);

} // namespace slabhull
