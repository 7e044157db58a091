// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vector_algebra.h"

#include "slabhull/core/point.h"

#include <array>
#include <cmath>

namespace slabhull {

/// A plane in space with coordinates in it, right-handed with its normal.
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
        const Point<3> across = detail::cross(normal, axis);
        axes_[0] = detail::times(1 / detail::norm(across), across);
        axes_[1] = detail::cross(normal, axes_[0]);
    }

    const Point<3>& normal() const { return normal_; }
    double height(const Point<3>& x) const { return detail::dot(normal_, x) - offset_; }
    Point<2> project(const Point<3>& x) const { return {detail::dot(axes_[0], x), detail::dot(axes_[1], x)}; }
    Point<3> at(const Point<2>& p, double height) const {
        return detail::plus(detail::times(offset_ + height, normal_),
                            detail::plus(detail::times(p[0], axes_[0]), detail::times(p[1], axes_[1])));
    }

private:
    Point<3> normal_;
    double offset_;
    std::array<Point<3>, 2> axes_{};
};

} // namespace slabhull
