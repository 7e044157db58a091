// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/progress.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace slabhull {

/// How far a run of many slabs has come.
struct RunProgress {
    WorkState work;
    std::optional<int> slab;            ///< that is being built, from 0; empty while the initial cap is made
    int slabs = 0;                      ///< in all, as planned
    double share = 0;                   ///< of the run's time, in [0, 1]: an estimate that never falls
    std::uint64_t cells = 0;            ///< that hulls have so far, and what the stage at work has meshed
    double seconds = 0;                 ///< since the run began
    std::optional<double> seconds_left; ///< estimated; empty before the first boundary is known

    double cells_per_second() const { return seconds > 0 ? static_cast<double>(cells) / seconds : 0; }
};

/// Where the library's remarks go: warnings that a user should read, and the progress of long work.
/// The library itself prints nothing.
struct Listener {
    std::function<void(const std::string& text)> warning = [](const std::string&) {};
    /// Some twenty times a second, by one thread at a time; share 1 at the end. It must not throw.
    std::function<void(const RunProgress& run)> progress = [](const RunProgress&) {};
};

} // namespace slabhull
