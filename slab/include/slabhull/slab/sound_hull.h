// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/check_parts.h"
#include "slabhull/slab/stage_clock.h"

#include <optional>
#include <string>

namespace slabhull {

/// The reports on a hull without findings.
struct SoundHull {
    HullReport report;
    std::optional<EmbeddingSummary> embedding; ///< empty if not asked for
};

/// Checks a hull that is to be written or solved on: check_hull() and, when `embedding` is wanted,
/// check_embedding(). Throws GeometryError if there are findings: their text, with their cells and vertices
/// as entities; `name` is what the message calls the hull, such as "the hull of slab 3". Books the stages
/// "checking" and "embedding".
template<int D>
SoundHull require_sound_hull(const Hull<D>& hull, const std::string& name, bool embedding, StageClock& clock);

/// The same of a hull whose parts are on ranks: check_parts() and check_embedding_of_parts(). Throws on all
/// ranks, or on none. Collective.
template<int D>
SoundHull require_sound_parts(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks,
                              const std::string& name, bool embedding, StageClock& clock);

} // namespace slabhull
