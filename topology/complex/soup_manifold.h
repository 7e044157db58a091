// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"

#include <cstddef>
#include <functional>
#include <span>

namespace slabhull {

/// What a soup has to be to be taken as a manifold.
struct SoupDemands {
    bool closed = false; ///< every facet in two cells
    /// The cell as the user knows it.
    std::function<Entity(Index cell)> name = [](Index cell) { return Entity{"cell", cell, ""}; };
};

/// The adjacency of a soup of D-simplices (D = 1, 2, 3) that is an oriented manifold, with or without
/// boundary. Throws GeometryError naming the cells at fault when it is none: see
/// SimplicialComplex::from_soup().
template<int D>
Adjacency<D> manifold_adjacency(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                const SoupDemands& demands = {});

} // namespace slabhull
