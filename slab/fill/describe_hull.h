// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/topology/filling.h"
#include "slabhull/topology/hull.h"

#include <fmt/format.h>
#include <limits>

namespace slabhull {

/// Copies from a hull to its filling: facets with attributes, ids and tracks of the hull's vertices. Needs
/// the filling's points. Throws FormatLimit for a patch whose attribute is beyond 32 bits.
template<int D>
void describe_hull(const Hull<D>& hull, Filling<D>& filling) {
    constexpr PatchNumber largest = std::numeric_limits<FacetAttribute>::max() - 2;
    for (const Patch& patch : hull.patches) {
        if (patch.number > largest) {
            throw FormatLimit{
                fmt::format("patch \"{}\" has the number {}, but fillings have patches up to {}: "
                            "facets get 2 more; give it a smaller number in the mesher",
                            patch.name, patch.number, largest)};
        }
    }
    filling.facets = hull.cells;
    filling.facet_attribute.resize(hull.cells.size());
    for (std::size_t c = 0; c < hull.cells.size();) {
        const std::size_t end = hull.prism_end(c);
        const FacetAttribute attribute = attribute_of(hull, c);
        for (; c < end; ++c) {
            filling.facet_attribute[c] = attribute;
        }
    }
    filling.patches = hull.patches;
    filling.vertex_ids = hull.vertex_ids;
    filling.track_ids = hull.track_ids;
    filling.hull_points = hull.points.size();
    filling.slab = hull.slab;
    filling.time = hull.time;
    filling.vertex_ids.append_run(-1, filling.points.size() - hull.points.size(), 0);
}

} // namespace slabhull
