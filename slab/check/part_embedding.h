// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"
#include "slabhull/geometry/hull_embedding.h"
#include "slabhull/slab/hull_part.h"

#include <array>
#include <cstddef>
#include <vector>

namespace slabhull {

/// Two cells of a hull that cross, in its numbers, and their first and last times.
template<int D>
struct CrossingInHull {
    Crossing<D + 1> cells;
    std::array<std::array<double, 2>, 2> times;
};

template<int D>
struct PartsEmbedding {
    HullEmbedding<D> all;                     ///< but its crossings
    std::vector<CrossingInHull<D>> crossings; ///< sorted; of cells without extent none
};

/// What examine_embedding() finds in a hull of which each rank has a part; the same on all ranks. Each
/// decides the pairs of its own cells, and those with cells of later ranks whose boxes meet its own: these
/// are sent to it. Stars of vertices are proven by the lowest rank that has a cell there. Where there are
/// more crossings than the limit, others than those of examine_embedding() may be listed. Collective. Needs:
/// a hull whose facets are in two cells that agree. Cost: near-linear in the part and what is sent; about 60
/// bytes per cell of both.
template<int D>
PartsEmbedding<D> examine_parts(const HullPart<D>& part, Communicator& ranks, std::size_t limit);

} // namespace slabhull
