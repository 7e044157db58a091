// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace slabhull::detail {

/// A segment (D = 2) or triangle (D = 3) in space.
template<int D>
using FacetCorners = std::array<Point<D>, D>;

/// The point of a facet closest to a given point.
template<int D>
struct FootOnFacet {
    Point<D> point{};
    double distance = 0;
    int rank = 0; ///< number of corners that do not contribute: 0 inside a facet, D - 1 at a corner
};

template<int D>
FootOnFacet<D> closest_on_segment(const Point<D>& x, const Point<D>& a, const Point<D>& b) {
    const Point<D> edge = minus(b, a);
    const double square = dot(edge, edge);
    const double place = square > 0 ? dot(minus(x, a), edge) / square : 0;
    constexpr int inside = D - 2; // the inside of a triangle's edge is on the triangle's rim
    if (!(place > 0 && place < 1)) {
        const Point<D>& end = place <= 0 ? a : b;
        return {end, norm(minus(x, end)), inside + 1};
    }
    // Computed from the nearer end, so that both directions of an edge give the same point.
    const Point<D> foot =
        place <= 0.5 ? plus(a, times(place, edge)) : minus(b, times(dot(minus(b, x), edge) / square, edge));
    return {foot, norm(minus(x, foot)), inside};
}

inline FootOnFacet<2> closest_on_facet(const Point<2>& x, const FacetCorners<2>& segment) {
    return closest_on_segment<2>(x, segment[0], segment[1]);
}

/// Turns a triangle so that its longest edge comes first.
inline FacetCorners<3> longest_edge_first(FacetCorners<3> t) {
    const auto square = [&t](std::size_t i) {
        const Point<3> edge = minus(t[(i + 1) % 3], t[i]);
        return dot(edge, edge);
    };
    const std::array<double, 3> squares{square(0), square(1), square(2)};
    const auto longest = std::max_element(squares.begin(), squares.end()) - squares.begin();
    std::rotate(t.begin(), t.begin() + longest, t.end());
    return t;
}

/// Uses orthonormal coordinates along the longest edge ab and normal to it, so that even in a needle the
/// position along it keeps its digits:
///
///          c = (along, height)
///         / `.
///       a-----b = (length, 0)
inline FootOnFacet<3> closest_on_facet(const Point<3>& x, const FacetCorners<3>& triangle) {
    const auto [a, b, c] = longest_edge_first(triangle);
    const Point<3> edge = minus(b, a);
    const double length = norm(edge);
    if (length > 0) {
        const Point<3> u = times(1 / length, edge);
        const double along = dot(minus(c, a), u);
        const Point<3> rise = minus(minus(c, a), times(along, u));
        const double height = norm(rise);
        if (height > 0) {
            const Point<3> v = times(1 / height, rise);
            const Point<3> arm = minus(x, a);
            const double s = dot(arm, u);
            const double t = dot(arm, v);
            const bool right_of_ac = s * height >= t * along;
            const bool left_of_bc = (length - s) * height >= t * (length - along);
            if (t >= 0 && right_of_ac && left_of_bc) {
                const Point<3> foot = plus(a, plus(times(s, u), times(t, v)));
                return {foot, norm(minus(x, foot)), 0};
            }
        }
    }
    FootOnFacet<3> best = closest_on_segment<3>(x, a, b);
    for (const FootOnFacet<3>& other : {closest_on_segment<3>(x, b, c), closest_on_segment<3>(x, c, a)}) {
        best = other.distance < best.distance ? other : best;
    }
    return best;
}

} // namespace slabhull::detail
