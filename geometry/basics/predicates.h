// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>

/// Geometric predicates without rounding errors: filtered floating point first, exact arithmetic if that is
/// not conclusive.
/// Needs: finite coordinates. CGAL's kernel stays behind predicates.cpp.
namespace slabhull::exact {

using Segment2 = std::array<Point<2>, 2>;
using Segment3 = std::array<Point<3>, 2>;
using Triangle3 = std::array<Point<3>, 3>;

/// Sign of det[b - a, c - a].
int orientation(const Point<2>& a, const Point<2>& b, const Point<2>& c);
/// Sign of det[b - a, c - a, d - a].
int orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d);

/// Sign of the simplex's measure.
inline int orientation(const std::array<Point<2>, 3>& s) {
    return orientation(s[0], s[1], s[2]);
}
inline int orientation(const std::array<Point<3>, 4>& s) {
    return orientation(s[0], s[1], s[2], s[3]);
}

/// Whether a facet has no extent: a segment of one point, a triangle with collinear corners.
bool degenerate(const Segment2& s);
bool degenerate(const Triangle3& t);

/// Whether closed, non-degenerate sets have a point in common.
bool meet(const Segment2& s, const Segment2& t);
bool meet(const Triangle3& s, const Triangle3& t);
bool meet(const Segment3& s, const Triangle3& t);

} // namespace slabhull::exact
