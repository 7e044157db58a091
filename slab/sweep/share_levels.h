// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/hull_part.h"
#include "slabhull/slab/sweep.h"

#include <cstddef>

namespace slabhull {

class Communicator;

/// The levels of so many layers: those below and above each.
HullRange levels_of(const HullRange& layers);

/// The levels that a rank keeps of a sweep through so many layers: those of its share, range_of_rank().
/// Beside them each rank has the first and the last level.
HullRange levels_of_rank(std::size_t layers, const Communicator& ranks);

/// Releases all levels but `kept`, the first and the last.
template<int D>
void keep_levels(Sweep<D>& sweep, const HullRange& kept);

/// Gives this rank the levels `wanted`, and releases all others but the first and the last. Needs: a rank
/// that has each level that is wanted. Those that a rank lacks are sent to it by the lowest that has them.
/// Collective.
template<int D>
void share_levels(Sweep<D>& sweep, const HullRange& wanted, Communicator& ranks);

} // namespace slabhull
