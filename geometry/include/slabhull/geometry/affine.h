// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace slabhull {

/// The map x -> A x + b of R^D; the identity when default-constructed.
template<int D>
struct AffineMap {
    std::array<Point<D>, D> rows = unit_rows(); ///< of the linear part A
    Point<D> shift{};                           ///< b

    Point<D> operator()(const Point<D>& x) const {
        Point<D> image = linear(x);
        for (std::size_t i = 0; i < D; ++i) {
            image[i] += shift[i];
        }
        return image;
    }

    /// A x alone: the map of differences of points.
    Point<D> linear(const Point<D>& x) const {
        Point<D> image{};
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < D; ++j) {
                image[i] += rows[i][j] * x[j];
            }
        }
        return image;
    }

    /// Factor by which a similarity stretches lengths (for other maps: the root mean square over all
    /// directions).
    double scale() const {
        double squares = 0;
        for (const Point<D>& row : rows) {
            for (const double entry : row) {
                squares += entry * entry;
            }
        }
        return std::sqrt(squares / D);
    }

    static constexpr std::array<Point<D>, D> unit_rows() {
        std::array<Point<D>, D> unit{};
        for (std::size_t i = 0; i < D; ++i) {
            unit[i][i] = 1;
        }
        return unit;
    }
};

/// The map with linear part `rows` that fixes `centre`.
template<int D>
AffineMap<D> map_about(const Point<D>& centre, const std::array<Point<D>, D>& rows) {
    AffineMap<D> map{rows, {}};
    const Point<D> image = map.linear(centre);
    for (std::size_t i = 0; i < D; ++i) {
        map.shift[i] = centre[i] - image[i];
    }
    return map;
}

/// x -> outer(inner(x)).
template<int D>
AffineMap<D> compose(const AffineMap<D>& outer, const AffineMap<D>& inner) {
    AffineMap<D> both{{}, outer(inner.shift)};
    for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
            for (std::size_t k = 0; k < D; ++k) {
                both.rows[i][j] += outer.rows[i][k] * inner.rows[k][j];
            }
        }
    }
    return both;
}

/// Inverse of a similarity (a rotation or reflection, times a positive factor, plus a shift).
/// Throws GeometryError if the map is not a similarity: singular, shearing, or not finite.
template<int D>
AffineMap<D> inverse_of_similarity(const AffineMap<D>& map);

} // namespace slabhull
