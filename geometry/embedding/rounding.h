// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace slabhull {

/// Largest relative error of one rounding to nearest.
inline constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

} // namespace slabhull
