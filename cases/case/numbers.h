// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"

#include <algorithm>

namespace slabhull {

/// The first D of the numbers as a point; those that are not given are 0.
template<int D>
Point<D> as_point(const Numbers& numbers) {
    Point<D> point{};
    std::copy_n(numbers.begin(), std::min<std::size_t>(D, numbers.size()), point.begin());
    return point;
}

} // namespace slabhull
