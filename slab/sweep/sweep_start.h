// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/sweep.h"

#include <utility>
#include <vector>

namespace slabhull {

/// A sweep that has its first level only: the boundary's places in the cap that it bounds.
template<int D>
Sweep<D> started_sweep(const Boundary<D>& boundary, const SpatialMesh<D>& cap, std::vector<double> times) {
    Sweep<D> sweep;
    sweep.boundary = boundary;
    sweep.times = std::move(times);
    Array<Point<D>> places;
    for (const Index v : boundary.mesh_vertices()) {
        places.push_back(cap.points[v]);
    }
    sweep.positions.push_back(std::move(places));
    return sweep;
}

} // namespace slabhull
