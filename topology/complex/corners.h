// SPDX-License-Identifier: BSD-3-Clause
// Corners of a simplex, found without a branch.
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>

namespace slabhull {

/// Exclusive or: that of a cell and that of one of its facets give the vertex that the facet leaves out.
template<int D>
Index parity(const Simplex<D>& corners) {
    Index result = 0;
    for (const Index v : corners) {
        result ^= v;
    }
    return result;
}

/// The place of a vertex of the simplex; 0 for others.
template<int D>
std::size_t place_of(Index vertex, const Simplex<D>& corners) {
    std::size_t place = 0;
    for (std::size_t i = 1; i <= D; ++i) {
        place = corners[i] == vertex ? i : place;
    }
    return place;
}

} // namespace slabhull
