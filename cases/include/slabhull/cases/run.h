// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/core/message.h"

#include <filesystem>
#include <vector>

namespace slabhull {

class Communicator;

struct RunResult {
    std::vector<std::filesystem::path> files; ///< written, in order
    std::size_t cells = 0;                    ///< hull simplices over all slabs
    std::size_t points = 0;
    int slabs = 0;
};

struct RunOptions {
    bool resume = false; ///< go on from the checkpoint in the output directory, if there is one
    /// Ranks that run the case together; each calls run_case(). nullptr: this process alone.
    Communicator* ranks = nullptr;
};

/// Runs a case: builds, checks and writes each of its slabs, then report.json (docs/case-file.md lists the
/// files). A slab is written only when its check found nothing; slabs written before a later one fails stay,
/// with a report. After each slab a checkpoint is on disk; a run that resumes from it writes the very bytes
/// that it would have written without the interruption (report.json differs in its times). Throws the errors
/// of the steps.
/// In ranks, N of them: each makes and writes its piece, as with `output.pieces = N` and, where the case does
/// not say otherwise, `cap.blocks = N`; the bytes are those of such a run of one process. The first rank
/// fills slabs, keeps the report and tells the listener; the others' listeners hear nothing. All files of a
/// slab get their names, or none. What goes wrong on one rank is thrown on all. Throws UsageError for what
/// ranks cannot do (docs/ranks.md), naming the setting.
RunResult run_case(const Case& the_case, const Listener& listener, const RunOptions& options = {});

/// The version of this library, such as "0.1.0".
const char* version();

} // namespace slabhull
