// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/topology/boundary.h"

#include <vector>

namespace slabhull {

/// One point inside each body that a domain's boundary surrounds, well off its surface. It tells a mesher
/// that fills closed surfaces what to leave empty. Each is proven, by exact winding numbers, to be inside its
/// body and outside the domain.
/// Needs: the boundary of a domain, see require_domain_boundary().
/// Throws GeometryError if a body is so thin that no such point is found in floating point.
std::vector<Point<3>> hole_seeds(const Boundary<3>& boundary, const Surface<3>& surface);

} // namespace slabhull
