// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/point.h"

#include <array>
#include <cmath>

namespace slabhull {

/// A plane in space with a coordinate system, right-handed with its normal.
class PlaneFrame {
public:
    /// All x with normal . x = offset; the normal has length 1.
    PlaneFrame(const Point<3>& normal, double offset) : normal_{normal}, offset_{offset} {
        std::size_t least = 0;
        for (std::size_t k = 1; k < 3; ++k) {
            least = std::abs(normal[k]) < std::abs(normal[least]) ? k : least;
        }
        Point<3> axis{};
        axis[least] = 1;
        const Point<3> across = cross(normal, axis);
        axes_[0] = times(1 / norm(across), across);
        axes_[1] = cross(normal, axes_[0]);
    }

    const Point<3>& normal() const { return normal_; }
    double height(const Point<3>& x) const { return dot(normal_, x) - offset_; }
    Point<2> project(const Point<3>& x) const { return {dot(axes_[0], x), dot(axes_[1], x)}; }
    Point<3> at(const Point<2>& p, double height) const {
        return plus(times(offset_ + height, normal_), plus(times(p[0], axes_[0]), times(p[1], axes_[1])));
    }

private:
    Point<3> normal_;
    double offset_;
    std::array<Point<3>, 2> axes_{};
};

} // namespace slabhull
