// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace slabhull {

/// How often a test repeats what it draws at random: a tenth of `count` under AddressSanitizer, which is some
/// ten times slower and looks for faults of another kind.
constexpr int rounds(int count) {
#ifdef __SANITIZE_ADDRESS__
    return (count + 9) / 10;
#else
    return count;
#endif
}

} // namespace slabhull
