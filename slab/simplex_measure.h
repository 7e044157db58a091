// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/measures.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace slabhull {

/// Measure of a D-simplex in R^N; N is D or D + 1, for edges anything.
template<int D, int N>
double simplex_measure(const std::array<Point<N>, D + 1>& corners) {
    if constexpr (N == D) {
        return std::abs(signed_measure<D>(corners));
    } else {
        Point<N> normal{};
        if constexpr (D == 1) {
            for (std::size_t k = 0; k < N; ++k) {
                normal[k] = corners[1][k] - corners[0][k]; // as long as a normal
            }
        } else {
            normal = simplex_normal<D>(corners);
        }
        double square = 0;
        for (const double x : normal) {
            square += x * x;
        }
        return std::sqrt(square);
    }
}

} // namespace slabhull
