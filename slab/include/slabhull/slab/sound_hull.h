// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/stage_clock.h"

#include <optional>
#include <string>

namespace slabhull {

/// What is known of a hull in which nothing was found.
struct SoundHull {
    HullReport report;
    std::optional<EmbeddingSummary> embedding; ///< nothing when it was not asked for
};

/// Checks a hull that is to be written or solved on: check_hull() and, when `embedding` is wanted,
/// check_embedding(). Throws GeometryError with the findings in words, and their cells and vertices as the
/// entities, when there are any; `name` is what the message calls the hull, such as "the hull of slab 3".
/// Books the stages "checking" and "embedding".
template<int D>
SoundHull require_sound_hull(const Hull<D>& hull, const std::string& name, bool embedding, StageClock& clock);

} // namespace slabhull
