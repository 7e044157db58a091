// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

// Vectors and numbers given by users: printed for messages, and checked.
namespace slabhull::detail {

/// "(1, 2.5, 0)"
template<std::size_t N>
std::string to_text(const std::array<double, N>& a) {
    return fmt::format("({})", fmt::join(a, ", "));
}

template<std::size_t N>
void require_finite(const std::array<double, N>& a, const char* what) {
    if (!all_finite(a)) {
        throw UsageError{fmt::format("{} must be finite numbers, not {}", what, to_text(a))};
    }
}

inline void require_finite(double value, const char* what) {
    if (!std::isfinite(value)) {
        throw UsageError{fmt::format("{} must be a finite number, not {}", what, value)};
    }
}

inline void require_positive(double value, const char* what) {
    if (!(std::isfinite(value) && value > 0)) {
        throw UsageError{fmt::format("{} must be positive and finite, not {}", what, value)};
    }
}

/// `direction` scaled to length 1. Throws UsageError if it is zero.
template<std::size_t N>
std::array<double, N> unit_vector(const std::array<double, N>& direction, const char* what) {
    require_finite(direction, what);
    double largest = 0; // divided out first: squares of tiny and huge entries leave the range of double
    for (const double entry : direction) {
        largest = std::max(largest, std::abs(entry));
    }
    if (largest == 0) {
        throw UsageError{fmt::format("{} must not be zero", what)};
    }
    std::array<double, N> scaled;
    std::transform(direction.begin(), direction.end(), scaled.begin(),
                   [largest](double entry) { return entry / largest; });
    return times(1 / norm(scaled), scaled);
}

} // namespace slabhull::detail
