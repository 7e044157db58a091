// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/side_walls.h"

#include "slab/fill/staircase.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace slabhull {

template<int D>
SideWalls<D>::SideWalls(const Hull<D>& hull, const SlabColumns<D>& columns)
    : hull_{hull}, columns_{columns}, staircase_(hull.facet_patch.size(), 1) {
    for (std::size_t c = 0; c < columns_.cells.size(); ++c) {
        for (std::size_t k = 0; k <= D; ++k) {
            if (columns_.swept_facet[c][k] != no_index) {
                read_wall(c, k);
            }
        }
    }
    if constexpr (D == 3) {
        collect_edges();
        for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
            for (const auto& [facet, corners] : others_) {
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::array edge{corners[i == 0 ? 1 : 0], corners[i == 2 ? 1 : 2]};
                    splits_[layer * edges_.size() + quad(edge[0], edge[1])] =
                        read_quad_split<D>(hull_, columns_, layer, wall(layer, facet), edge);
                }
            }
        }
        require_alike();
    }
}

template<int D>
void SideWalls<D>::read_wall(std::size_t cell, std::size_t k) {
    const Index facet = columns_.swept_facet[cell][k];
    const Facet<D> corners = without<D>(columns_.cells[cell], k);
    for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
        if (!is_staircase<D>(hull_, columns_, layer, wall(layer, facet), corners)) {
            staircase_[facet] = 0;
        }
    }
    if (staircase_[facet] == 0) {
        others_.emplace_back(facet, corners);
    }
}

/// Checks that each quadrilateral has a centre in all layers or in none, so that all layers have the same
/// cells.
template<int D>
void SideWalls<D>::require_alike() const {
    for (std::size_t k = edges_.size(); k < splits_.size(); ++k) {
        if (splits_[k].pieces() != splits_[k % edges_.size()].pieces()) {
            throw GeometryError{fmt::format("layers {} and 0 of the side are split in different ways, which "
                                            "cannot be filled",
                                            k / edges_.size()),
                                {{"layer", static_cast<std::int64_t>(k / edges_.size()), {}}}};
        }
    }
}

template<int D>
void SideWalls<D>::collect_edges() {
    for (const auto& [facet, corners] : others_) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = i + 1; j < D; ++j) {
                edges_.push_back({corners[i], corners[j]});
            }
        }
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    splits_.resize(columns_.layers() * edges_.size());
}

template<int D>
Index SideWalls<D>::quad(Index a, Index b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::array{a, b});
    return found != edges_.end() && *found == std::array{a, b} ? static_cast<Index>(found - edges_.begin())
                                                               : no_index;
}

template class SideWalls<2>;
template class SideWalls<3>;

} // namespace slabhull
