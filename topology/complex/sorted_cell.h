// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>

namespace slabhull {

/// The vertices of a simplex in ascending order, with where they stood and the parity of the permutation.
template<int D>
struct SortedCell {
    Simplex<D> vertices;
    std::array<std::uint8_t, D + 1> place; ///< place[k]: local index of vertices[k] in the cell as given
    bool odd;

    /// Whether the cell induces the negative orientation on the facet opposite to vertices[k], taken
    /// ascending. Two cells agree on a facet when this differs.
    bool facet_odd(std::size_t k) const { return odd != ((k & 1) != 0); }

    /// The facet opposite to vertices[k], ascending.
    Facet<D> facet(std::size_t k) const {
        Facet<D> result{};
        for (std::size_t i = 0; i < D; ++i) {
            result[i] = vertices[i < k ? i : i + 1];
        }
        return result;
    }
};

/// Sorts by ranks, without a branch: each pair is compared once. Equal vertices keep their order.
template<int D>
SortedCell<D> sort_cell(const Simplex<D>& cell) {
    std::array<std::uint8_t, D + 1> rank{};
    bool odd = false;
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = i + 1; j <= D; ++j) {
            const bool swapped = cell[i] > cell[j];
            rank[i] = static_cast<std::uint8_t>(rank[i] + swapped);
            rank[j] = static_cast<std::uint8_t>(rank[j] + !swapped);
            odd ^= swapped;
        }
    }
    SortedCell<D> sorted{};
    for (std::size_t i = 0; i <= D; ++i) {
        sorted.vertices[rank[i]] = cell[i];
        sorted.place[rank[i]] = static_cast<std::uint8_t>(i);
    }
    sorted.odd = odd;
    return sorted;
}

} // namespace slabhull
