// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"

#include "cases/case/key_table.h"

#include <filesystem>

namespace slabhull {

/// What the tables of motions and projections refer to.
struct PatchKeysContext {
    int dimension = 3;
    double duration = 1;             ///< of the whole case
    std::filesystem::path directory; ///< that paths are relative to
};

/// Reads a table [motion.PATCH]. Throws UsageError like KeyTable.
MotionSpec read_motion(KeyTable table, const PatchKeysContext& context);

/// Reads a table [project.PATCH]. Throws UsageError like KeyTable.
ProjectionSpec read_projection(KeyTable table, const PatchKeysContext& context);

} // namespace slabhull
