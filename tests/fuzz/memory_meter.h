// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace fuzz {

/// The most bytes that were allocated at any moment since it was made and not freed. Counted by the hooks of
/// AddressSanitizer: without it always 0. One at a time.
class MemoryMeter {
public:
    MemoryMeter();
    std::size_t peak() const;
    /// Whether it counts.
    static bool works();
};

} // namespace fuzz
