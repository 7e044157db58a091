// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>

namespace slabhull {

/// Sign of det[v_1 - v_0 .. v_N - v_0], exact (N = 2, 3, 4): 1, -1, or 0 for a simplex without extent.
/// Decided by floating point with an error bound, or else by rational arithmetic.
/// Needs: finite coordinates. Cost: 0.1 microseconds, some 100 times as much in rational arithmetic.
template<int N>
int simplex_sign(const std::array<Point<N>, N + 1>& corners);

} // namespace slabhull
