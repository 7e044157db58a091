// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/components.h"

#include "slabhull/geometry/measures.h"

namespace slabhull {

namespace {

int sign(double x) {
    return (x > 0) - (x < 0);
}

/// Side of p from the line through a and b, projected along the first axis. Ties are broken as if p were
/// moved by (e, e^2).
int side_of(const Point<3>& a, const Point<3>& b, const Point<3>& p) {
    const int side = exact::orientation({a[1], a[2]}, {b[1], b[2]}, {p[1], p[2]});
    if (side != 0) {
        return side;
    }
    const int first_order = sign(a[2] - b[2]);
    return first_order != 0 ? first_order : sign(b[1] - a[1]);
}

/// Signed measure of the simplex between a point and a facet: positive when the point is on the facet's inner
/// side.
template<int D>
double cone(const Point<D>& apex, const FacetCorners<D>& corners) {
    std::array<Point<D>, D + 1> simplex{apex};
    std::copy(corners.begin(), corners.end(), simplex.begin() + 1);
    return outward_sign<D>(0) * signed_measure<D>(simplex);
}

} // namespace

template<int D>
std::vector<double> enclosed_by_components(const FacetComponents<D>& components, const Surface<D>& surface) {
    std::vector<double> enclosed(components.count(), 0);
    for (Index facet = 0; facet < surface.facets.size(); ++facet) {
        const Index part = components.component(facet);
        const Point<D>& apex = surface.points[surface.facets[components.first_facet(part)][0]];
        enclosed[part] += cone<D>(apex, corners_of_facet(surface, facet));
    }
    return enclosed;
}

int detail::line_passes(const FacetCorners<2>& facet, const Point<2>& p) {
    const bool starts_above = facet[0][1] > p[1];
    const bool ends_above = facet[1][1] > p[1];
    return static_cast<int>(starts_above) - static_cast<int>(ends_above);
}

int detail::line_passes(const FacetCorners<3>& facet, const Point<3>& p) {
    const int side = side_of(facet[0], facet[1], p);
    return side_of(facet[1], facet[2], p) == side && side_of(facet[2], facet[0], p) == side ? side : 0;
}

template std::vector<double> enclosed_by_components<2>(const FacetComponents<2>&, const Surface<2>&);
template std::vector<double> enclosed_by_components<3>(const FacetComponents<3>&, const Surface<3>&);

} // namespace slabhull
