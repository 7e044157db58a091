// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace slabhull {

namespace {

/// An edge is long if it exceeds this multiple of the spacing at the third vertex of its ideal triangle.
constexpr double long_edge = 2;
/// Wanted spacing at the middle of a long edge, as a fraction of its length, and its decrease per unit of
/// distance.
constexpr double middle_size = 0.5;
constexpr double decline = 0.4;
/// Increase of the spacing per unit of distance that still allows good angles.
constexpr double steepest_growth = 0.5;

double distance(const Point<2>& a, const Point<2>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
}

} // namespace

CapSpacing::CapSpacing(const Surface<2>& boundary, Wanted wanted, double growth)
    : wanted_{std::move(wanted)} {
    find_long_edges(boundary);
    if (!long_edges_.empty()) {
        const std::span<const Point<2>> points{boundary.points};
        steepest_.emplace(
            points, boundary_spacing<2>(points, boundary.facets),
            Grading{std::max(growth, steepest_growth), std::numeric_limits<double>::infinity()});
    }
}

void CapSpacing::find_long_edges(const Surface<2>& boundary) {
    Array<Box<2>> boxes;
    for (const Facet<2>& edge : boundary.facets) {
        const Point<2>& a = boundary.points[edge[0]];
        const Point<2>& b = boundary.points[edge[1]];
        const double length = distance(a, b);
        const Point<2> middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
        // The domain is on the right.
        const Point<2> third{middle[0] + (b[1] - a[1]) / 2, middle[1] - (b[0] - a[0]) / 2};
        if (length <= long_edge * wanted_(third)) {
            continue;
        }
        const double size = middle_size * length;
        const double reach = size / decline;
        long_edges_.push_back({middle, size});
        boxes.push_back({{middle[0] - reach, middle[1] - reach}, {middle[0] + reach, middle[1] + reach}});
    }
    if (!boxes.empty()) {
        reach_.emplace(boxes);
    }
}

double CapSpacing::raised(const Point<2>& x, double wanted) const {
    double size = wanted;
    reach_->find({x, x}, [&](Index edge) {
        size = std::max(size, long_edges_[edge].size - decline * distance(x, long_edges_[edge].middle));
    });
    return size > wanted ? std::max(wanted, std::min(size, (*steepest_)(x))) : wanted;
}

} // namespace slabhull
