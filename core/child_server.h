// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace slabhull {

/// What the ended fresh children of this process took, see run_in_fresh_child(): they are not its children
/// for the system.
struct FreshChildrenUsage {
    double cpu_seconds = 0;
    std::size_t peak_bytes = 0; ///< of the largest
};
FreshChildrenUsage usage_of_fresh_children();

} // namespace slabhull
