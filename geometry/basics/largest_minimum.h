// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

/// x -> gradient . x + value.
template<int N>
struct AffineFunction {
    Point<N> gradient;
    double value;

    double at(const Point<N>& x) const {
        double sum = value;
        for (std::size_t k = 0; k < N; ++k) {
            sum += gradient[k] * x[k];
        }
        return sum;
    }
};

/// The point at which the smallest of some affine functions is largest: a linear program in N + 1 unknowns,
/// solved by exchange (the simplex method for its dual). Arithmetic is rounded; if you need a guarantee,
/// evaluate the functions at the result. The point lies in a simplex whose inscribed ball has a radius of
/// some hundred units about the origin, so an unbounded program has a result, too: scale to the size of the
/// solution.
/// Cost: linear in the functions for each exchange, of which there are some N to 5 N.
template<int N>
Point<N> largest_minimum(std::span<const AffineFunction<N>> functions);

extern template Point<2> largest_minimum<2>(std::span<const AffineFunction<2>>);
extern template Point<3> largest_minimum<3>(std::span<const AffineFunction<3>>);
extern template Point<4> largest_minimum<4>(std::span<const AffineFunction<4>>);

} // namespace slabhull
