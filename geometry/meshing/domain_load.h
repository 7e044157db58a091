// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/spatial_mesh.h"

#include <vector>

namespace slabhull {

/// A piece of a domain, and the number of cells wanted in it.
struct LoadSample {
    Point<3> at{};
    double spacing = 0; ///< wanted there
    double cubes = 0;   ///< wanted cubes in the piece: its volume / spacing^3
};

/// Samples the integral of h^-3 over the domain inside a surface, in pieces with edges of about two spacings.
/// Needs: the boundary of a domain, see require_domain_boundary().
/// Cost: near-linear in the pieces; one ray for each at the boundary. Does not depend on the number of
/// threads.
std::vector<LoadSample> sample_load(const Surface<3>& surface, const SizeField<3>& size);

double cubes_in(const std::vector<LoadSample>& load);

} // namespace slabhull
