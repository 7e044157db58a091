// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/core/vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace slabhull {

/// Quality of a cell: the smallest sine of its (dihedral) angles, negative for a cell that is inverted. So
/// angles near 180 degrees count as small ones do. 0 for cells without extent.
inline double cell_quality(const std::array<Point<2>, 3>& p) {
    const Point<2> a = minus(p[1], p[0]);
    const Point<2> b = minus(p[2], p[0]);
    const double la = norm(a);
    const double lb = norm(b);
    const double lc = distance(p[1], p[2]);
    const double largest_product = std::max({la * lb, la * lc, lb * lc});
    return largest_product > 0 ? (a[0] * b[1] - a[1] * b[0]) / largest_product : 0;
}

inline double cell_quality(const std::array<Point<3>, 4>& p) {
    // sin of the angle at edge ij = 6 V |ij| / (|n_k| |n_l|), with facet normals of twice the area
    const auto cross = [](const Point<3>& a, const Point<3>& b) {
        return Point<3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Point<3> a = minus(p[1], p[0]);
    const Point<3> b = minus(p[2], p[0]);
    const Point<3> c = minus(p[3], p[0]);
    const Point<3> bc = cross(b, c);
    const double volume = dot(a, bc);
    const std::array<double, 4> area{norm(cross(minus(p[2], p[1]), minus(p[3], p[1]))), norm(bc),
                                     norm(cross(c, a)), norm(cross(a, b))};
    double largest = 0; // of |n_k| |n_l| / |ij|
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            std::size_t k = 0;
            while (k == i || k == j) {
                ++k;
            }
            const std::size_t l = 6 - i - j - k;
            const double length = distance(p[i], p[j]);
            if (!(length > 0)) {
                return 0;
            }
            largest = std::max(largest, area[k] * area[l] / length);
        }
    }
    return largest > 0 ? volume / largest : 0;
}

inline double quality_of_angle(double degrees) {
    return std::sin(degrees * std::numbers::pi / 180);
}

} // namespace slabhull
