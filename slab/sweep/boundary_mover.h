// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/slab/sweep.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// Size of a mesh, relative to which rounding is judged: the largest distance from its first point.
template<int D>
double extent_of(std::span<const Point<D>> points) {
    double largest = 0;
    for (const auto& point : points) {
        largest = std::max(largest, distance(point, points.front()));
    }
    return largest;
}

/// The tracks of vertices of a boundary.
template<int D>
std::vector<TrackId> tracks_of(const Boundary<D>& boundary, std::span<const Index> vertices) {
    std::vector<TrackId> tracks;
    for (const Index v : vertices) {
        tracks.push_back(boundary.tracks()[v]);
    }
    return tracks;
}

/// Where the projection surface of a patch is at a time: it moves with the patch, and stands still if that
/// stretches.
template<int D>
AffineMap<D> surface_placement(const MovingPatch<D>& moving, double motion_start, double to) {
    return moving.motion == nullptr ? AffineMap<D>{} : moving.motion->map(motion_start, to).value();
}

/// Takes the boundary of a domain from one time to another: step 3 of the method for all patches together.
/// Field motions are integrated, nodal ones evaluated, stretching patches follow them; finally vertices are
/// projected onto the surfaces of their patches.
template<int D>
class BoundaryMover {
public:
    /// `sweep` gives the boundary and its first places; all must outlive the mover.
    BoundaryMover(const Sweep<D>& sweep, const PatchMotions<D>& motions, double motion_start,
                  const TrajectoryOptions& options);

    /// The places at time `to` of vertices that are at `from_places` at time `from`. Throws GeometryError
    /// naming the patches and vertices where motions disagree, the vertices that projection would move by
    /// more than half of their shortest edge.
    Array<Point<D>> move(const Array<Point<D>>& from_places, double from, double to);

    /// The two halves of move(): where the motions alone take the vertices, in this many substeps ...
    Array<Point<D>> drift(const Array<Point<D>>& from_places, double from, double to, int substeps);
    Array<Point<D>> drift(const Array<Point<D>>& from_places, double from, double to) {
        return drift(from_places, from, to, options_.substeps);
    }
    /// ... and the way from there onto the surfaces of their patches.
    void project(Array<Point<D>>& places, double to);

    /// A set of patches whose vertices follow the same motion: one patch, all those that stand still, or all
    /// those that stretch.
    struct MotionGroup {
        std::vector<PatchNumber> patches;
        const MovingPatch<D>* moving = nullptr; ///< null: stands still
        std::vector<Index> vertices{};          ///< ascending
        std::vector<Point<D>> places{};         ///< of those vertices
    };
    const std::vector<MotionGroup>& groups() const { return groups_; }
    /// Number of substeps for a part of a layer, at least one.
    int substeps_of(double part) const {
        return std::max(1, static_cast<int>(std::ceil(part * options_.substeps - 1e-6)));
    }

    /// How far projection moved the vertices of each patch, over all moves.
    const std::map<PatchNumber, ProjectionReport>& projected() const { return projected_; }

private:
    /// Vertices that are projected onto the surfaces of the same patches.
    struct Crease {
        std::vector<PatchNumber> patches; ///< ascending; more than one where they meet
        std::vector<Index> vertices;
    };

    void make_groups();
    void make_creases();
    void advance(MotionGroup& group, const Array<Point<D>>& before, double from, double to,
                 int substeps) const;
    Array<Point<D>> joined(const Array<Point<D>>& before, double to) const;
    void project_crease(const Crease& crease, Array<Point<D>>& places, std::span<const double> room,
                        double to);
    void require_room(const Crease& crease, std::span<const double> moved, std::span<const double> room,
                      const Array<Point<D>>& places, double to) const;
    [[noreturn]] void refuse(const MotionGroup& a, const MotionGroup& b, double to) const;
    std::string names(const std::vector<PatchNumber>& patches) const;
    Entity vertex_entity(Index vertex, const std::vector<PatchNumber>& patches) const;

    const Sweep<D>& sweep_;
    const PatchMotions<D>& motions_;
    double motion_start_;
    const TrajectoryOptions& options_;
    double extent_;
    std::vector<MotionGroup> groups_; ///< the stretching one, if any, is the last
    std::vector<Crease> creases_;
    std::map<PatchNumber, ProjectionReport> projected_;
};

} // namespace slabhull
