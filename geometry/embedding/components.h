// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/basics/predicates.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/topology/facet_components.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace slabhull {

/// Signed measure that each component of a surface encloses: positive for an outer boundary, negative around
/// a body.
template<int D>
std::vector<double> enclosed_by_components(const FacetComponents<D>& components, const Surface<D>& surface);

namespace detail {

/// Crossing of a facet by the line through p along the first axis: the sign of the facet's normal on that
/// axis, or 0 if they do not meet. The line is perturbed symbolically, so that it meets no edge.
int line_passes(const FacetCorners<2>& facet, const Point<2>& p);
int line_passes(const FacetCorners<3>& facet, const Point<3>& p);

} // namespace detail

/// Winding number around p of the facets for which counts(facet) is true. Needs: p on none of them. Exact:
/// signed crossings of a ray.
/// Cost: that of finding the boxes along the ray.
template<int D, class Counts>
int winding_number(const Surface<D>& surface, const BoxTree<D>& tree, const Point<D>& p, Counts&& counts) {
    Box<D> ray{p, p};
    ray.high[0] = std::numeric_limits<double>::infinity();
    int winding = 0;
    tree.find(ray, [&](Index facet) {
        if (!counts(facet)) {
            return;
        }
        const FacetCorners<D> corners = corners_of_facet(surface, facet);
        const int turn = detail::line_passes(corners, p);
        if (turn != 0) {
            std::array<Point<D>, D + 1> with_p;
            std::copy(corners.begin(), corners.end(), with_p.begin());
            with_p[D] = p;
            winding += exact::orientation(with_p) == -turn ? turn : 0; // the crossing is ahead of p
        }
    });
    return winding;
}

} // namespace slabhull
