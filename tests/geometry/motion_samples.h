// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/motion.h"

namespace slabhull::tests {

/// The first D of three coordinates.
template<int D>
Point<D> corner(double first, double second, double third) {
    if constexpr (D == 2) {
        return {first, second};
    } else {
        return {first, second, third};
    }
}

/// At one point.
template<int D>
Point<D> velocity_at(const Motion<D>& motion, const Point<D>& x, double t) {
    Point<D> v;
    motion.velocity({&x, 1}, t, {&v, 1});
    return v;
}

} // namespace slabhull::tests
