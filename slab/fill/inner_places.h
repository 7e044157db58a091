// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

namespace slabhull {

/// Places the inner vertices of the caps on each inner level by move_cap(): from the initial cap to each
/// level or, if that inverts cells, from level to level. In the second case, the gap left to the terminating
/// cap is spread over all levels in proportion to time. If both ways invert cells, the first is taken. Cost:
/// one or two calls of move_cap() per level.
template<int D>
void place_inside(const Hull<D>& hull, const SlabColumns<D>& columns, Filling<D>& filling);

} // namespace slabhull
