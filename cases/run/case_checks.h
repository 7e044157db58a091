// SPDX-License-Identifier: BSD-3-Clause
// What can be said of a case before its files are read.
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"

#include <cstdint>

namespace slabhull {

/// Throws InputError, naming the key, for a file of the case that is not there, and UsageError for one that
/// the run would replace or remove in its folder.
void require_files(const Case& the_case);

/// Of the case file, and of the tables and surfaces that its motions and projections follow.
std::uint32_t checksum_of_motions(const Case& the_case);

/// The case as so many ranks run it: output in as many pieces, caps in as many blocks unless the case gives
/// their number. Throws UsageError, naming the setting, for what ranks cannot do.
Case case_in_ranks(Case the_case, int ranks);

/// Warns of rotations that turn so far that their rate was hardly meant to be in radians.
void warn_of_turns(const Case& the_case, const Listener& listener);

} // namespace slabhull
