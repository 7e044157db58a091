// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/measures.h"
#include "slabhull/topology/filling.h"

#include <cstddef>

namespace slabhull {

/// Mean ratios of a filling's simplices, 1 for the regular one, 0 for a flat one, and dihedral angles.
struct FillingQuality {
    double smallest = 0;
    double one_per_cent = 0; ///< first percentile
    double median = 0;
    AngleRange angles{180, 0}; ///< between facets, over all simplices
    double time_scale = 1;     ///< the length that a unit of time counts for
};

/// q = d (d + 1) / 2 (V / V_regular)^(2/d) / (sum of the squared edges), d = D + 1, V_regular that of edge 1.
/// A layer's duration counts for the mean edge of the initial cap, for angles, too. Cost: linear; 4 bytes per
/// simplex.
template<int D>
FillingQuality filling_quality(const Filling<D>& filling, std::size_t layers);

} // namespace slabhull
