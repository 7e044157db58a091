// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/hull.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace slabhull {

/// What a boundary facet of a filling belongs to, as files have it: 1 the initial cap, 2 the terminating one,
/// 2 + its patch on the side.
using FacetAttribute = std::int32_t;

template<int D>
FacetAttribute attribute_of(const Hull<D>& hull, std::size_t cell) {
    switch (hull.region(cell)) {
    case Region::initial:
        return 1;
    case Region::terminating:
        return 2;
    case Region::intermediate:
        break;
    }
    return 2 + hull.patch(cell);
}

/// One slab as a space-time mesh: simplices of dimension D + 1 that fill its hull, time last. Each is
/// positively oriented: det[v_1 - v_0 .. v_(D+1) - v_0] > 0. The hull's vertices come first and its cells are
/// the boundary facets, both with their numbers and bit for bit, so the initial facets of a slab are the
/// terminating ones of the slab before, by id. 40 bytes a pentatope (D = 3), 32 a tetrahedron.
template<int D>
struct Filling {
    Array<Point<D + 1>> points;
    Array<Simplex<D + 1>> cells;
    Array<Neighbors<D + 1>> neighbors; ///< no_index across the hull

    Array<Simplex<D>> facets; ///< the hull's cells: their normals point out of the slab
    Array<FacetAttribute> facet_attribute;
    PatchList patches;

    IntegerList vertex_ids; ///< -1 for vertices inside, which no other slab has
    IntegerList track_ids;  ///< no_track for the centres of cells and of facets

    std::size_t hull_points = 0;
    std::size_t steiner_points = 0; ///< centres, the last of the vertices
    int slab = 0;
    std::array<double, 2> time{};
};

} // namespace slabhull
