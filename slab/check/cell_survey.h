// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/check_shape.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/hull.h"

#include <array>
#include <cstddef>

namespace slabhull {

/// Cells are summed up in pieces of so many, from the hull's first; so sums depend neither on threads nor on
/// ranks.
inline constexpr std::size_t cells_per_survey = 1 << 15;

template<int D>
using SumsByRegion = std::array<MeasureSums<D>, 3>;

struct CellFaults {
    bool degenerate = false;
    bool inverted = false; ///< a cap cell that does not face out of its cap
};

/// Adds a cell to the sums. `sign` is 1, or -1 for a hull that is inside out as a whole.
template<int D>
CellFaults survey_cell(Region region, const std::array<Point<D + 1>, D + 1>& corners,
                       const Point<D + 1>& origin, double sign, SumsByRegion<D>& sums) {
    const Point<D + 1> normal = sums[static_cast<std::size_t>(region)].add(corners, origin);
    const double out_of_cap = region == Region::intermediate ? 0
                              : region == Region::initial    ? -normal[D]
                                                             : normal[D];
    return {is_degenerate<D, D + 1>(corners, norm(normal)), sign * out_of_cap < 0};
}

} // namespace slabhull
