// SPDX-License-Identifier: BSD-3-Clause
// Hulls over grids whose caps are one mesh moved, so that they can be filled.
#pragma once

#include "slab/swept_grid.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/fill.h"

#include <cstddef>
#include <vector>

namespace slabhull::specimens {

/// Every vertex of the caps on a track, as in a march that moves its caps. Tracks run against the numbers.
template<int D>
void track_inside(SpatialMesh<D>& initial, SpatialMesh<D>& terminating, const Boundary<D>& boundary) {
    const std::size_t count = initial.points.size();
    std::size_t next = boundary.vertex_count();
    std::vector<Index> image(count, no_index);
    for (Index v = 0; v < boundary.vertex_count(); ++v) {
        image[boundary.mesh_vertices()[v]] = v;
    }
    for (std::size_t v = 0; v < count; ++v) {
        initial.track_ids[v] = static_cast<TrackId>(1 + count - v);
        const std::size_t end = image[v] == no_index ? next++ : image[v];
        terminating.track_ids[end] = initial.track_ids[v];
    }
}

template<int D>
MotionPointer<D> turn() {
    Point<D> axis{}; // not looked at for D = 2
    axis[D - 1] = 1;
    return rotation<D>(axis, {}, 0.4);
}

/// The hull of a grid that turns or stands.
template<int D>
Hull<D> hull_over(const Grid<D>& grid, const SideOptions& side, std::size_t layers, bool turns) {
    IdCounter ids;
    std::vector<double> times;
    for (std::size_t k = 0; k <= layers; ++k) {
        times.push_back(0.5 + 0.25 * static_cast<double>(k) / static_cast<double>(layers));
    }
    auto parts = next_slab<D>(as_cap<D>(grid, ids), times, turns ? turn<D>() : nullptr, ids);
    track_inside<D>(parts.initial, parts.terminating, parts.sweep.boundary);
    return stitch<D>(parts.initial, parts.sweep, parts.terminating, side, ids);
}

template<int D>
std::vector<Split> splits() {
    if constexpr (D == 2) {
        return {Split::diagonal, Split::centre};
    } else {
        return {Split::A, Split::B, Split::C, Split::D, Split::E};
    }
}

} // namespace slabhull::specimens
