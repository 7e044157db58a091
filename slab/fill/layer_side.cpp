// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/layer_side.h"

#include <algorithm>

namespace slabhull {

template<int D>
LayerSide<D>::LayerSide(const Hull<D>& hull, const SlabColumns<D>& columns, std::span<const Index> column,
                        std::size_t layer, const CellRange& cells)
    : hull_{hull}, columns_{columns}, column_{column}, layer_{layer} {
    for (Index first = cells.first; first < cells.end;) {
        const auto end = static_cast<Index>(hull.prism_end(first));
        read_part({first, end});
        first = end;
    }
    std::sort(walls_.begin(), walls_.end(), [](const Wall& a, const Wall& b) { return a.facet < b.facet; });
    const auto by_edge = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(quads_.begin(), quads_.end(), by_edge); // twice the same, read from either side
}

/// Reads the prism over one facet, which has its columns only, or the cone of a change, which has more.
template<int D>
void LayerSide<D>::read_part(const CellRange& cells) {
    std::vector<Index> found;
    for (Index c = cells.first; c < cells.end; ++c) {
        for (const Index v : hull_.cells[c]) {
            if (column_[v] != no_index) {
                found.push_back(column_[v]);
            }
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    if (found.size() == D) {
        Facet<D> facet;
        std::copy(found.begin(), found.end(), facet.begin());
        const bool staircase = is_staircase<D>(hull_, columns_, layer_, cells, facet);
        walls_.push_back({facet, cells, staircase});
        if (!staircase) {
            ++others_;
            read_quads(cells, {facet});
        }
        return;
    }
    const std::vector<Facet<D>> below = facets_below(cells);
    for (const Facet<D>& facet : below) {
        walls_.push_back({facet, cells, false});
    }
    others_ += below.size();
    read_quads(cells, below);
}

/// The facets at the layer's start that a change removes.
template<int D>
std::vector<Facet<D>> LayerSide<D>::facets_below(const CellRange& cells) const {
    std::vector<Facet<D>> facets;
    for (Index c = cells.first; c < cells.end; ++c) {
        Facet<D> facet;
        std::size_t below = 0;
        for (const Index v : hull_.cells[c]) {
            if (column_[v] != no_index && columns_.at(layer_, column_[v]) == v) {
                facet[below++] = column_[v];
            }
        }
        if (below == D) {
            std::sort(facet.begin(), facet.end());
            facets.push_back(facet);
        }
    }
    return facets;
}

/// Reads the quadrilaterals around some facets: over the edges that only one of them has.
template<int D>
void LayerSide<D>::read_quads(const CellRange& cells, const std::vector<Facet<D>>& facets) {
    if constexpr (D == 3) {
        std::vector<std::array<Index, 2>> edges;
        for (const Facet<D>& facet : facets) {
            for (std::size_t i = 0; i < D; ++i) {
                edges.push_back({facet[i == 0 ? 1 : 0], facet[i == 2 ? 1 : 2]});
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t k = 0; k < edges.size();) {
            const bool shared = k + 1 < edges.size() && edges[k + 1] == edges[k];
            if (!shared) {
                const QuadSplit split = read_quad_split<D>(hull_, columns_, layer_, cells, edges[k]);
                if (!split.staircase()) {
                    quads_.emplace_back(edges[k], split);
                }
            }
            k += shared ? 2 : 1;
        }
    }
}

template<int D>
const typename LayerSide<D>::Wall* LayerSide<D>::wall(const Facet<D>& sorted) const {
    const auto found = std::lower_bound(walls_.begin(), walls_.end(), sorted,
                                        [](const Wall& a, const Facet<D>& b) { return a.facet < b; });
    return found != walls_.end() && found->facet == sorted ? &*found : nullptr;
}

template<int D>
const QuadSplit* LayerSide<D>::quad(Index a, Index b) const {
    const std::array<Index, 2> edge{a, b};
    const auto found = std::lower_bound(quads_.begin(), quads_.end(), edge,
                                        [](const auto& q, const auto& e) { return q.first < e; });
    return found != quads_.end() && found->first == edge ? &found->second : nullptr;
}

template class LayerSide<2>;
template class LayerSide<3>;

} // namespace slabhull
