// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/hull_embedding.h"

#include "geometry/embedding/cell_groups.h"
#include "geometry/embedding/embedded_caps.h"
#include "geometry/embedding/embedding_search.h"

#include <algorithm>
#include <array>
#include <vector>

namespace slabhull {

template<int D>
HullEmbedding<D> examine_embedding(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                                   const AdjacencyView<D>& adjacency, std::size_t limit) {
    const std::array<double, 2> times = time_span<D>(points, cells);
    std::vector<CapOf> caps = find_caps<D>(points, cells, times);
    const bool caps_proven = caps_are_embedded<D>(points, cells, adjacency, caps, times);
    std::vector<bool> tested(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        tested[c] = !caps_proven || caps[c] == CapOf::none;
    }
    std::vector<CapOf>{}.swap(caps);
    const CellGroups<D> groups{cells, points.size(), tested};
    const std::span<const Neighbors<D>> neighbors =
        adjacency.defects.empty() ? adjacency.neighbors : std::span<const Neighbors<D>>{};
    HullEmbedding<D> result = search_crossings<D>({points,
                                                   {cells, neighbors, {}, {}, {}, {}},
                                                   groups,
                                                   [](Index) { return true; },
                                                   [](Array<StarState>&) {}},
                                                  limit);
    result.caps_proven = caps_proven;
    result.tested_cells = static_cast<std::size_t>(std::count(tested.begin(), tested.end(), true));
    return result;
}

template HullEmbedding<2> examine_embedding<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                               const AdjacencyView<2>&, std::size_t);
template HullEmbedding<3> examine_embedding<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                               const AdjacencyView<3>&, std::size_t);

} // namespace slabhull
