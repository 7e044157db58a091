// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"

#include <cstddef>
#include <string>
#include <vector>

namespace slabhull {

struct PatchPlan {
    std::string name;
    std::size_t facets = 0;
    bool moves = false;
};

struct SlabPlan {
    double begin = 0;
    double end = 0;
    std::size_t layers = 0;
    double side_simplices = 0;
};

/// What running a case would take. Simplices of caps, bytes and seconds are estimates.
struct CasePlan {
    std::vector<PatchPlan> patches;
    std::size_t facets = 0;
    std::vector<SlabPlan> slabs;
    double cap_simplices = 0; ///< of one cap
    double bytes = 0;         ///< of the largest slab
    double seconds = 0;
};

/// Reads all that a case needs, moves its boundary through all slabs, and meshes nothing. Caps that are
/// adapted, and slabs that would end before their boundary tangles, may have more layers. Throws what
/// run_case() throws for the input, the motions, and wishes that cannot be met.
CasePlan plan_case(const Case& the_case, const Listener& listener);

} // namespace slabhull
