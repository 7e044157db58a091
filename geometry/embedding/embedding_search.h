// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/joined_spans.h"
#include "geometry/embedding/cell_groups.h"

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/geometry/hull_embedding.h"

#include <cstddef>
#include <functional>
#include <span>

namespace slabhull {

/// What is known of the groups of cells around a vertex.
enum class StarState : char {
    none,  ///< not examined
    open,  ///< examined, and not proven: its groups are to be paired
    proven ///< all its cells meet in common faces only
};

/// Groups of cells that are to be paired with each other, but for those of ghosts alone: another search has
/// these.
template<int D>
struct GroupsToPair {
    JoinedSpans<Point<D + 1>> points;
    /// Of a closed and oriented complex, with neighbours; without these, stars stay open.
    PartialMesh<D> mesh;
    const CellGroups<D>& groups;
    /// Called with the vertices whose stars shall be examined: the groups may want more cells for that.
    std::function<void(std::span<const Index> centres)> complete_groups;
    /// Whether all cells at a vertex are here, with the whole groups of those tested.
    std::function<bool(Index vertex)> is_complete;
    /// Called with the states of all vertices when stars have been examined: more may be known to be proven.
    std::function<void(Array<StarState>& stars)> complete_stars;
};

/// Decides which of the tested cells cross; see examine_embedding(). The result has no caps and tested cells.
template<int D>
HullEmbedding<D> search_crossings(const GroupsToPair<D>& all, std::size_t limit);

extern template HullEmbedding<2> search_crossings<2>(const GroupsToPair<2>&, std::size_t);
extern template HullEmbedding<3> search_crossings<3>(const GroupsToPair<3>&, std::size_t);

} // namespace slabhull
