// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/core/vector.h"

#include <array>
#include <cstddef>
#include <span>

namespace slabhull {

/// The time scale by which the mean layer lasts one mean edge of the initial cap, whose cells are given.
/// Edges count once per cell. Without cells, edges count as 1.
template<int D>
double layer_scale(std::span<const Simplex<D>> cap, std::span<const Point<D + 1>> points, std::size_t layers,
                   const std::array<double, 2>& time) {
    double sum = 0;
    for (const Simplex<D>& cell : cap) {
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                sum += distance(points[cell[i]], points[cell[j]]);
            }
        }
    }
    const double mean = cap.empty() ? 1 : sum / (0.5 * D * (D + 1) * static_cast<double>(cap.size()));
    return mean * static_cast<double>(layers) / (time[1] - time[0]);
}

} // namespace slabhull
