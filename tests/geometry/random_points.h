// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/vector.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace slabhull::tests {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// `count` points with coordinates in [-reach, reach), the same in every run and with every standard library.
template<int D>
std::vector<Point<D>> random_points(std::size_t count, double reach, std::uint64_t seed = 1) {
    std::mt19937_64 generator{seed};
    std::vector<Point<D>> points(count);
    for (Point<D>& point : points) {
        for (double& coordinate : point) {
            const auto bits = static_cast<double>(generator() >> 11);
            coordinate = reach * (std::ldexp(bits, -52) - 1);
        }
    }
    return points;
}

} // namespace slabhull::tests
