// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cmath>
#include <cstddef>

namespace slabhull {

template<int D>
double distance(const Point<D>& a, const Point<D>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < D; ++k) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return std::sqrt(sum);
}

} // namespace slabhull
