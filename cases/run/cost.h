// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"

namespace slabhull {

// What simplices of a hull cost a run, for estimates.

/// Memory while a hull is built, checked and written.
inline double bytes_per_simplex(const Case& the_case) {
    return the_case.check_embedding ? 60 : 45;
}
/// Built, checked and written on two cores of 2020.
inline constexpr double simplices_per_second = 6e5;

} // namespace slabhull
