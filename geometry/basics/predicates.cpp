// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/basics/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace slabhull::exact {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 cgal(const Point<2>& p) {
    return {p[0], p[1]};
}
Kernel::Point_3 cgal(const Point<3>& p) {
    return {p[0], p[1], p[2]};
}
Kernel::Segment_2 cgal(const Segment2& s) {
    return {cgal(s[0]), cgal(s[1])};
}
Kernel::Segment_3 cgal(const Segment3& s) {
    return {cgal(s[0]), cgal(s[1])};
}
Kernel::Triangle_3 cgal(const Triangle3& t) {
    return {cgal(t[0]), cgal(t[1]), cgal(t[2])};
}

} // namespace

int orientation(const Point<2>& a, const Point<2>& b, const Point<2>& c) {
    return CGAL::orientation(cgal(a), cgal(b), cgal(c));
}

int orientation(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& d) {
    return CGAL::orientation(cgal(a), cgal(b), cgal(c), cgal(d));
}

bool degenerate(const Segment2& s) {
    return s[0] == s[1];
}

bool degenerate(const Triangle3& t) {
    return CGAL::collinear(cgal(t[0]), cgal(t[1]), cgal(t[2]));
}

bool meet(const Segment2& s, const Segment2& t) {
    return CGAL::do_intersect(cgal(s), cgal(t));
}
bool meet(const Triangle3& s, const Triangle3& t) {
    return CGAL::do_intersect(cgal(s), cgal(t));
}
bool meet(const Segment3& s, const Triangle3& t) {
    return CGAL::do_intersect(cgal(s), cgal(t));
}

} // namespace slabhull::exact
