// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Triangles in the plane, for the planar mesher.
namespace slabhull::plane {

using Corners = std::array<Point<2>, 3>;

inline double cross(const Point<2>& a, const Point<2>& b) {
    return a[0] * b[1] - a[1] * b[0];
}

/// The local numbers after and before i, counter-clockwise.
constexpr std::size_t next(std::size_t i) {
    return i == 2 ? 0 : i + 1;
}
constexpr std::size_t previous(std::size_t i) {
    return i == 0 ? 2 : i - 1;
}

/// Shape of a triangle relative to its shortest edge.
struct Shape {
    std::size_t apex = 0; ///< local number of the vertex opposite to the shortest edge
    double shortest = 0;  ///< square of the shortest edge's length
    double others = 0;    ///< product of the squares of the other two lengths
    double double_area = 0;

    explicit Shape(const Corners& p) : double_area{cross(minus(p[1], p[0]), minus(p[2], p[0]))} {
        std::array<double, 3> opposite;
        for (std::size_t i = 0; i < 3; ++i) {
            opposite[i] = squared_distance(p[next(i)], p[previous(i)]);
            apex = opposite[i] < opposite[apex] ? i : apex;
        }
        shortest = opposite[apex];
        others = opposite[next(apex)] * opposite[previous(apex)];
    }

    double circumradius() const { return std::sqrt(shortest * others) / (2 * double_area); }
    /// Sine of the smallest angle.
    double sine() const { return double_area / std::sqrt(others); }
};

/// Points on the perpendicular bisector of an edge; the positive side is left of a -> b.
class Bisector {
public:
    Bisector(const Point<2>& a, const Point<2>& b)
        : middle_{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}, half_{std::sqrt(squared_distance(a, b)) / 2},
          inward_{(a[1] - b[1]) / (2 * half_), (b[0] - a[0]) / (2 * half_)} {}

    double half_length() const { return half_; }
    Point<2> at(double height) const {
        return {middle_[0] + height * inward_[0], middle_[1] + height * inward_[1]};
    }

private:
    Point<2> middle_;
    double half_;
    Point<2> inward_;
};

} // namespace slabhull::plane
