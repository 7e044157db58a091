// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"

namespace slabhull {

/// The corners of a cell without the one at `place`.
template<int D>
Facet<D> without(const Simplex<D>& cell, std::size_t place) {
    Facet<D> facet{};
    for (std::size_t k = 0; k < D; ++k) {
        facet[k] = cell[k < place ? k : k + 1];
    }
    return facet;
}

// The staircase splits a prism over N vertices with ascending columns v into N simplices: piece m has
// v_0 .. v_m below and v_m .. v_(N-1) above. Its facets are staircases again, so neighbours agree:
//
//        piece:     0          1          2
//        above    0 1 2        1 2          2        facet between pieces m and m + 1: piece m without m
//        above below    0          0 1        0 1 2

/// Piece m over the N corners, in ascending columns, in a layer.
template<int D, std::size_t N>
std::array<Index, N + 1> staircase_piece(const SlabColumns<D>& columns, std::size_t layer,
                                         const std::array<Index, N>& corners, std::size_t m) {
    std::array<Index, N + 1> piece{};
    for (std::size_t k = 0; k <= N; ++k) {
        piece[k] = k <= m ? columns.at(layer, corners[k]) : columns.at(layer + 1, corners[k - 1]);
    }
    return piece;
}

/// The piece of a cell's staircase that has piece m of the wall opposite to corner `place`.
constexpr std::size_t piece_at_wall(std::size_t m, std::size_t place) {
    return m < place ? m : m + 1;
}

} // namespace slabhull
