// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/in_circle.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace slabhull::exact {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 cgal_point(const Point<2>& p) {
    return {p[0], p[1]};
}

} // namespace

bool in_circle(const plane::Corners& triangle, const Point<2>& p) {
    return CGAL::side_of_oriented_circle(cgal_point(triangle[0]), cgal_point(triangle[1]),
                                         cgal_point(triangle[2]), cgal_point(p)) == CGAL::ON_POSITIVE_SIDE;
}

} // namespace slabhull::exact
