// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/wall_pieces.h"

#include "slab/fill/staircase.h"
#include "topology/complex/sorted_cell.h"
#include <algorithm>
#include <array>

namespace slabhull {

template<int D>
bool WallPieces<D>::meets_other_split(const Simplex<D>& cell) const {
    Simplex<D> sorted = cell;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 0; k <= D; ++k) {
        if (const auto* wall = side_->wall(without<D>(sorted, k)); wall != nullptr && !wall->staircase) {
            return true;
        }
        for (std::size_t j = 0; D == 3 && j < k; ++j) {
            if (side_->quad(sorted[j], sorted[k]) != nullptr) {
                return true;
            }
        }
    }
    return false;
}

template<int D>
void WallPieces<D>::append(std::size_t layer, std::span<const Facet<D>> facets,
                           std::vector<Simplex<D>>& pieces) {
    std::vector<Index> met; // first cells of walls: a change has several facets
    for (const Facet<D>& outward : facets) {
        const auto [facet, place, odd] = sort_cell<D - 1>(outward);
        if (const auto* wall = side_->wall(facet)) {
            if (std::find(met.begin(), met.end(), wall->cells.first) == met.end()) {
                met.push_back(wall->cells.first);
                const auto cells = side_->hull().cells.begin(); // outward, as hulls have them
                pieces.insert(pieces.end(), cells + wall->cells.first, cells + wall->cells.end);
            }
            continue;
        }
        bool other = false;
        for (std::size_t i = 0; D == 3 && i < D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                other = other || side_->quad(facet[j], facet[i]) != nullptr;
            }
        }
        other ? append_cone(layer, facet, odd, pieces) : append_staircase(layer, facet, odd, pieces);
    }
}

/// `odd`: whether ascending columns are inward.
template<int D>
void WallPieces<D>::append_staircase(std::size_t layer, const Facet<D>& sorted, bool odd,
                                     std::vector<Simplex<D>>& pieces) const {
    for (std::size_t m = 0; m < D; ++m) {
        Simplex<D> piece = staircase_piece<D>(columns_, layer, sorted, m);
        if (odd != ((m + D) % 2 == 1)) {
            std::swap(piece[0], piece[1]);
        }
        pieces.push_back(piece);
    }
}

template<int D>
Index WallPieces<D>::centre(std::size_t layer, const Facet<D>& sorted) {
    const auto [at, is_new] = centres_.try_emplace(sorted, static_cast<Index>(filling_.points.size()));
    if (is_new) {
        Point<D + 1> mean{};
        for (const std::size_t level : {layer, layer + 1}) {
            for (const Index column : sorted) {
                for (std::size_t k = 0; k <= D; ++k) {
                    mean[k] += filling_.points[columns_.at(level, column)][k] / (2.0 * D);
                }
            }
        }
        filling_.points.push_back(mean);
    }
    return at->second;
}

/// The cone from the wall's centre over the facets below and above and over its quadrilaterals.
template<int D>
void WallPieces<D>::append_cone(std::size_t layer, const Facet<D>& sorted, bool odd,
                                std::vector<Simplex<D>>& pieces) {
    if constexpr (D == 3) {
        const Index apex = centre(layer, sorted);
        std::array<Index, 3> below;
        std::array<Index, 3> above;
        for (std::size_t k = 0; k < 3; ++k) {
            below[k] = columns_.at(layer, sorted[k]);
            above[k] = columns_.at(layer + 1, sorted[k]);
        }
        // outward if ascending columns are outward
        const auto add = [&](Index a, Index b, Index c) {
            pieces.push_back(odd ? Simplex<D>{apex, b, a, c} : Simplex<D>{apex, a, b, c});
        };
        add(below[0], below[1], below[2]);
        add(above[1], above[0], above[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = k == 2 ? 0 : k; // the edges 01, 12 and 20 run around the facet
            const std::size_t j = k == 2 ? 2 : k + 1;
            const bool against = k == 2;
            const QuadSplit* other = side_->quad(sorted[i], sorted[j]);
            const QuadSplit split = other == nullptr ? QuadSplit{} : *other;
            const auto quad = [&](Index a, Index b, Index c) { against ? add(a, c, b) : add(a, b, c); };
            if (split.centre != no_index) {
                quad(split.centre, below[j], below[i]);
                quad(split.centre, above[i], above[j]);
                quad(split.centre, below[i], above[i]);
                quad(split.centre, above[j], below[j]);
            } else if (split.rising) {
                quad(below[i], above[j], below[j]);
                quad(below[i], above[i], above[j]);
            } else {
                quad(below[i], above[i], below[j]);
                quad(below[j], above[i], above[j]);
            }
        }
    }
}

template class WallPieces<2>;
template class WallPieces<3>;

} // namespace slabhull
