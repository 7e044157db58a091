// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/message.h"

#include <filesystem>
#include <string>
#include <vector>

namespace slabhull {

/// The text of a case file that starts from these files: a spatial mesh, or closed surfaces or curves, the
/// largest of which is the outer boundary if it has all others inside. Where nothing encloses the others
/// there is a box. Patches are listed with their extents, every section stands there commented out with its
/// defaults, and the case runs as it is: nothing moves yet. Paths are written relative to `directory`, where
/// the case file is to be. Warnings: as those of initial_domain(). Throws InputError for files that hold no
/// domain, UsageError for files that do not go together.
std::string starting_case(const std::vector<std::filesystem::path>& files,
                          const std::filesystem::path& directory, const Listener& listener);

} // namespace slabhull
