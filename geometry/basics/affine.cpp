// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/affine.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace slabhull {

namespace {

/// Largest entry of A A^T / s^2 - 1: zero for a similarity of scale s.
template<int D>
double shear(const std::array<Point<D>, D>& rows, double squared_scale) {
    double worst = 0;
    for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double product = 0;
            for (std::size_t k = 0; k < D; ++k) {
                product += rows[i][k] * rows[j][k];
            }
            worst = std::max(worst, std::abs(product / squared_scale - (i == j ? 1 : 0)));
        }
    }
    return worst;
}

} // namespace

template<int D>
AffineMap<D> inverse_of_similarity(const AffineMap<D>& map) {
    // Far above the rounding of composed rotations, far below a shear that visibly misplaces a point.
    constexpr double allowed_shear = 1e-9;
    const double squared_scale = map.scale() * map.scale();
    const bool regular = squared_scale >= std::numeric_limits<double>::min() && std::isfinite(squared_scale);
    // Written so that NaN is refused, too.
    if (!regular || !(shear<D>(map.rows, squared_scale) <= allowed_shear)) {
        throw GeometryError{
            fmt::format("a placement of scale {:g} is not a rotation with uniform scaling and cannot be "
                        "inverted; check the motion of the patch",
                        map.scale())};
    }
    AffineMap<D> inverse{{}, {}};
    for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
            inverse.rows[i][j] = map.rows[j][i] / squared_scale;
        }
    }
    const Point<D> back = inverse.linear(map.shift);
    for (std::size_t i = 0; i < D; ++i) {
        inverse.shift[i] = -back[i];
    }
    return inverse;
}

template AffineMap<2> inverse_of_similarity<2>(const AffineMap<2>&);
template AffineMap<3> inverse_of_similarity<3>(const AffineMap<3>&);

} // namespace slabhull
