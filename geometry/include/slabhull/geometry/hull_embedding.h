// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/topology/adjacency.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Whether a hull is embedded, that is, crosses itself nowhere.
template<int D>
struct HullEmbedding {
    /// Pairs of cells, as in find_crossings(): they meet elsewhere than in the face that they share; or one
    /// cell without extent, which stands as both. Sorted.
    std::vector<Crossing<D + 1>> crossings;
    bool all_listed = true; ///< false: there are more crossings than the limit
    /// Both caps were proven to be embedded as a whole, so that only the side's cells were paired.
    bool caps_proven = false;
    std::size_t tested_cells = 0;
    std::size_t stars = 0; ///< groups of cells around a vertex, that cover all cells that touch
    std::size_t proven_stars = 0;
    std::size_t group_pairs = 0;  ///< of groups that do not touch, but whose boxes meet
    std::size_t tested_pairs = 0; ///< of cells: in stars and pairs of groups that were not proven as a whole
    std::size_t exact_pairs = 0;  ///< of those: left to rational arithmetic (D = 3)
};

/// Finds the pairs of cells of a hull (or of any soup of D-simplices in R^(D+1), D = 2, 3) that cross, touch
/// or overlap; decided exactly. Coincident vertices with different numbers are seen as touching.
///
/// Two cells are apart when a hyperplane holds the vertices that they share and parts the others strictly.
/// It is looked for in floating point and proven by error bounds; a pair for which none is found is decided
/// in rational arithmetic. For D = 2 the pairs are decided as in find_crossings(). Pairs come from a tree of
/// boxes in space-time. The caps' cells are left out when the caps are proven otherwise: see embedded_caps.h.
/// Needs: cells that refer to points; finite coordinates; `adjacency` as build_adjacency() gives it.
/// Cost: near-linear where cells are of like size to their neighbours. About 170 extra bytes per tested cell.
/// The result does not depend on the number of threads.
template<int D>
HullEmbedding<D> examine_embedding(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                                   const AdjacencyView<D>& adjacency, std::size_t limit = 100);

} // namespace slabhull
