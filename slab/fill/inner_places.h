// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

namespace slabhull {

/// Puts the vertices inside the caps on each inner level, where move_cap() moves them: from the initial cap
/// to each level, or, where that turns cells inside out, from level to level; what the last step then leaves
/// to the terminating cap is spread over all, in proportion to time. Of two that are not sound the first is
/// taken. Cost: one or two calls of move_cap() per level.
template<int D>
void place_inside(const Hull<D>& hull, const SlabColumns<D>& columns, Filling<D>& filling);

} // namespace slabhull
