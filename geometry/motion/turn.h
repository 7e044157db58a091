// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/affine.h"

#include "geometry/basics/vector_algebra.h"

#include <cmath>

namespace slabhull::detail {

/// The cross product x -> w x x as a linear map.
inline AffineMap<3> cross_map(const Point<3>& w) {
    return {{{{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}}}, {}};
}

/// The linear map x -> axis x x for the normalised axis: a quarter turn in the plane normal to it.
/// Throws UsageError if the axis is zero.
inline AffineMap<3> quarter_turn(const Point<3>& axis) {
    return cross_map(unit_vector(axis, "the axis of a rotation"));
}

inline AffineMap<2> quarter_turn(const Point<2>&) {
    return {{{{0, -1}, {1, 0}}}, {}};
}

template<int D>
AffineMap<D> scaled(double factor, AffineMap<D> map) {
    for (Point<D>& row : map.rows) {
        row = times(factor, row);
    }
    map.shift = times(factor, map.shift);
    return map;
}

/// Rotation by an angle about the axis of the quarter turn W, through the origin. Rodrigues' formula,
/// R = 1 + sin(angle) W + (1 - cos(angle)) W^2, which holds in the plane, too.
template<int D>
AffineMap<D> turn_by(double angle, const AffineMap<D>& quarter) {
    const double versine = 2 * std::sin(angle / 2) * std::sin(angle / 2);
    const AffineMap<D> half = compose(quarter, quarter);
    AffineMap<D> turn;
    for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
            turn.rows[i][j] += std::sin(angle) * quarter.rows[i][j] + versine * half.rows[i][j];
        }
    }
    return turn;
}

} // namespace slabhull::detail
