// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"

#include <array>

namespace slabhull {

/// Finds a point from which the space-time cell of a cavity can be coned with positive volumes: its kernel's
/// place at half time, or else the solution of the linear program for the largest least distance to the
/// cell's boundary. Walls are taken as staircases; those with an edge on the domain's boundary also as
/// staircases the other way, since the hull's split decides there. False if there is no such point. Sets the
/// cavity's apex.
template<int D>
bool find_apex(const AdaptMesh<D>& mesh, const std::array<double, 2>& times, Cavity<D>& cavity);

} // namespace slabhull
