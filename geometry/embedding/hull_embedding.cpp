// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/hull_embedding.h"

#include "geometry/embedding/cell_groups.h"
#include "geometry/embedding/embedded_caps.h"
#include "geometry/embedding/embedding_search.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace slabhull {

template<int D>
HullEmbedding<D> examine_embedding(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                                   const AdjacencyView<D>& adjacency, std::size_t limit) {
    const std::array<double, 2> times = time_span<D>(points, cells);
    Array<CapOf> caps = find_caps<D>(points, cells, times);
    const bool caps_proven = caps_are_embedded<D>(points, cells, adjacency, caps, times);
    if (!caps_proven) { // all cells are taken for the side's, so that they are tested
        std::fill(caps.begin(), caps.end(), CapOf::none);
    }
    const auto tested = static_cast<std::size_t>(std::count(caps.begin(), caps.end(), CapOf::none));
    CellGroups<D> groups{cells, points.size(), caps};
    const auto complete_groups = [&](std::span<const Index> centres) {
        groups.complete(centres, caps);
        Array<CapOf>{}.swap(caps);
    };
    const std::span<const Neighbors<D>> neighbors =
        adjacency.defects.empty() ? adjacency.neighbors : std::span<const Neighbors<D>>{};
    HullEmbedding<D> result = search_crossings<D>({points,
                                                   {cells, neighbors, {}, {}, {}, {}},
                                                   groups,
                                                   complete_groups,
                                                   [](Index) { return true; },
                                                   [](Array<StarState>&) {}},
                                                  limit);
    result.caps_proven = caps_proven;
    result.tested_cells = tested;
    return result;
}

template HullEmbedding<2> examine_embedding<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                               const AdjacencyView<2>&, std::size_t);
template HullEmbedding<3> examine_embedding<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                               const AdjacencyView<3>&, std::size_t);

} // namespace slabhull
