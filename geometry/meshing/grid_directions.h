// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <cstddef>

namespace slabhull::detail {

/// The directions from a box of a grid to those at and around it, x first. The middle one, number 13, is
/// zero.
constexpr std::array<Point<3>, 27> grid_directions() {
    constexpr std::array<double, 3> steps{-1, 0, 1};
    std::array<Point<3>, 27> all{};
    std::size_t number = 0;
    for (const double z : steps) {
        for (const double y : steps) {
            for (const double x : steps) {
                all[number++] = {x, y, z};
            }
        }
    }
    return all;
}

} // namespace slabhull::detail
