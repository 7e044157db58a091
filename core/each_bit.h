// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>

namespace slabhull {

/// Calls visit(k) for each bit k that is set, ascending.
template<std::unsigned_integral Bits, class Visit>
void each_bit(Bits bits, const Visit& visit) {
    for (; bits != 0; bits &= bits - 1) {
        visit(static_cast<std::size_t>(std::countr_zero(bits)));
    }
}

} // namespace slabhull
