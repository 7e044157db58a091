// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/sweep/boundary_mover.h"
#include "slabhull/slab/sweep.h"

#include <array>
#include <span>

namespace slabhull {

/// The surfaces on which the vertices of patches lie, as they move.
template<int D>
class PatchSurfaces {
public:
    /// `extent`: of the mesh, relative to which rounding is judged.
    PatchSurfaces(const PatchMotions<D>& motions, double motion_start, double extent)
        : motions_{motions}, motion_start_{motion_start}, extent_{extent} {}

    bool has(PatchNumber patch) const {
        const auto found = motions_.find(patch);
        return found != motions_.end() && found->second.surface != nullptr;
    }
    /// Whether vertices of the patch cannot be made or ended: their motion is given for each, or follows from
    /// all others.
    bool has_fixed_vertices(PatchNumber patch) const {
        const auto found = motions_.find(patch);
        return found != motions_.end() &&
               (found->second.nodal != nullptr || found->second.stretch != nullptr);
    }
    /// The point of the patch's surface near a place; the place itself where the patch has none.
    Point<D> project(PatchNumber patch, const Point<D>& place, double time) const {
        if (!has(patch)) {
            return place;
        }
        const MovingPatch<D>& moving = motions_.at(patch);
        const std::array<PlacedSurface<D>, 1> surface{
            {{moving.surface.get(), surface_placement(moving, motion_start_, time)}}};
        std::array<Point<D>, 1> point{place};
        project_onto_all<D>(surface, point, extent_);
        return point[0];
    }

private:
    const PatchMotions<D>& motions_;
    double motion_start_;
    double extent_;
};

} // namespace slabhull
