// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/boundary.h"

#include <memory>
#include <set>
#include <span>

namespace slabhull {

/// Patches whose vertices follow those of their neighbours, as the wall of a cylinder follows a piston: the
/// displacement since the start is interpolated harmonically along the surface (cotangent weights of the
/// boundary where it was opened; D = 2: inverse lengths) from the vertices that they share with other
/// patches. So where a vertex is depends on where the neighbours are, not on the way there.
template<int D>
class Stretch {
public:
    virtual ~Stretch() = default;

    /// Puts the inner vertices of the patches where they belong, given those of all others.
    /// x: positions of all vertices of the boundary that it was made for, in its order.
    virtual void follow(std::span<Point<D>> x) const = 0;
};

template<int D>
using StretchPointer = std::shared_ptr<const Stretch<D>>;

/// The weights are those of the intrinsic Delaunay triangulation, which are not negative: vertices stay
/// between those that lead them, whatever the angles of the triangles. Cost: one factorisation here, 1.4 s of
/// one core for a wall of 160,000 vertices and 15 s for 640,000 (order 1.7); follow() then takes 0.05 and
/// 0.25 s. Throws UsageError naming a patch of which a connected part has no vertex in common with any patch
/// outside `patches`: nothing could lead it.
template<int D>
StretchPointer<D> harmonic_stretch(const Boundary<D>& boundary, const std::set<PatchNumber>& patches);

} // namespace slabhull
