// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/boundary.h"

#include <memory>
#include <set>
#include <span>

namespace slabhull {

/// Patches whose vertices follow those of neighbouring patches, as the wall of a cylinder follows a piston:
/// the displacement since the start is the harmonic interpolation along the surface (cotangent weights of the
/// boundary at the start; D = 2: inverse lengths) from the vertices shared with other patches. So positions
/// depend on the neighbours' positions, not on their paths.
template<int D>
class Stretch {
public:
    virtual ~Stretch() = default;

    /// Moves the inner vertices of the patches, given all others. x: positions of all vertices of the
    /// boundary that it was made for, in its order.
    virtual void follow(std::span<Point<D>> x) const = 0;
};

template<int D>
using StretchPointer = std::shared_ptr<const Stretch<D>>;

/// The weights are those of the intrinsic Delaunay triangulation, which are not negative: vertices stay
/// between those that they follow, whatever the angles of the triangles. Cost: one factorisation here, 1.4 s
/// of one core for a wall of 160,000 vertices and 15 s for 640,000 (order 1.7); follow() then takes 0.05 and
/// 0.25 s. Throws UsageError naming a patch with a connected part that shares no vertex with a patch outside
/// `patches`: it has nothing to follow.
template<int D>
StretchPointer<D> harmonic_stretch(const Boundary<D>& boundary, const std::set<PatchNumber>& patches);

} // namespace slabhull
