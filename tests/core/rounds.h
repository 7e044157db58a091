// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>

namespace slabhull {

/// How often a test repeats what it draws at random: a tenth of `count` under AddressSanitizer, which is some
/// ten times slower and looks for faults of another kind. SLABHULL_TEST_ROUNDS in the environment, a whole
/// number, is how many times as often.
inline int rounds(int count) {
    const char* const times = std::getenv("SLABHULL_TEST_ROUNDS");
    const int all = times != nullptr ? count * std::atoi(times) : count;
#ifdef __SANITIZE_ADDRESS__
    return (all + 9) / 10;
#else
    return all;
#endif
}

} // namespace slabhull
