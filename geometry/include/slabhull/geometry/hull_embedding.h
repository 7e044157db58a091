// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/topology/adjacency.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Whether a hull is embedded, that is, has no crossings.
template<int D>
struct HullEmbedding {
    /// Pairs of cells, as in find_crossings(), that meet outside their common face; or one cell without
    /// extent, which is both. Sorted.
    std::vector<Crossing<D + 1>> crossings;
    bool all_listed = true; ///< false: there are more crossings than the limit
    /// Both caps were proven embedded as a whole, so that only the side's cells were paired.
    bool caps_proven = false;
    std::size_t tested_cells = 0;
    std::size_t stars = 0; ///< groups of cells around a vertex that cover all cells that touch
    std::size_t proven_stars = 0;
    std::size_t group_pairs = 0;  ///< pairs of groups that do not touch, but whose boxes meet
    std::size_t tested_pairs = 0; ///< pairs of cells in stars and group pairs not proven as a whole
    std::size_t exact_pairs = 0;  ///< tested pairs decided by rational arithmetic (D = 3)
};

/// Finds the pairs of cells of a hull (or of any soup of D-simplices in R^(D+1), D = 2, 3) that cross, touch
/// or overlap; decided exactly. Coincident vertices with different numbers count as touching.
///
/// Two cells are apart if a hyperplane contains their shared vertices and strictly separates the others. It
/// is sought in floating point and proven by error bounds; pairs without such a proof are decided in rational
/// arithmetic. For D = 2 pairs are decided as in find_crossings(). Candidate pairs come from a tree of boxes
/// in space-time. The caps' cells are left out if the caps are proven embedded by another way: see
/// embedded_caps.h.
/// Needs: cells that refer to points; finite coordinates; `adjacency` as build_adjacency() gives it.
/// Cost: near-linear if cells are similar in size to their neighbours. About 20 extra bytes per tested cell
/// in prisms. The result does not depend on the number of threads.
template<int D>
HullEmbedding<D> examine_embedding(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                                   const AdjacencyView<D>& adjacency, std::size_t limit = 100);

} // namespace slabhull
