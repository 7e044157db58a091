// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

/// Whether `claimed` pairs all half-facets off: each cell has a neighbour across every facet, which shares
/// that facet, lies on its other side by its orientation, and has the cell as its neighbour there. A facet
/// of four cells passes when they are paired by twos, so this alone does not prove an adjacency. Needs:
/// vertices in range; false for a claim of the wrong length or range. Cost: linear, no memory.
template<int D>
bool pairs_facets(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed);

/// Whether the same holds for facet i of one cell. Needs: vertices in range; false for a neighbour that is
/// none.
template<int D>
bool is_paired(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed, Index cell,
               std::size_t i);

} // namespace slabhull
