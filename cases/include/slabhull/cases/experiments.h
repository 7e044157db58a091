// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"

#include <cstddef>
#include <span>
#include <string>

namespace slabhull {

/// Numbers of simplices and vertices of a hull.
struct HullCounts {
    std::size_t cells;
    std::size_t vertices;
};

/// A level of an experiment: a row of the paper's tables. Our hull at that refinement has the same counts
/// within 3 %.
struct ExperimentLevel {
    double refinement; ///< for experiment_at()
    HullCounts paper;
};

/// The six, in the paper's order.
std::span<const std::string> experiment_names();

/// The levels of an experiment, the first is level 1. Throws UsageError naming the experiments there are.
std::span<const ExperimentLevel> experiment_levels(const std::string& name);

} // namespace slabhull
