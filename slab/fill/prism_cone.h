// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace slabhull {

/// Points of the prism over a cell, in local numbers: corners below and above, the centres of the
/// quadrilaterals over edges (D = 3), of the walls over facets, of the prism.
template<int D>
struct CellPrismPoint {
    static constexpr std::size_t corners = D + 1;
    static constexpr std::size_t quads = D == 3 ? 6 : 0;

    static constexpr std::uint8_t below(std::size_t k) { return static_cast<std::uint8_t>(k); }
    static constexpr std::uint8_t above(std::size_t k) { return static_cast<std::uint8_t>(corners + k); }
    /// Over the edge between corners j < k.
    static constexpr std::uint8_t quad_centre(std::size_t j, std::size_t k) {
        return static_cast<std::uint8_t>(2 * corners + quad_number(j, k));
    }
    /// Over the facet opposite to corner k.
    static constexpr std::uint8_t wall_centre(std::size_t k) {
        return static_cast<std::uint8_t>(2 * corners + quads + k);
    }
    static constexpr std::uint8_t centre = static_cast<std::uint8_t>(3 * corners + quads);
    static constexpr std::size_t count = centre + 1u;

    static constexpr std::size_t quad_number(std::size_t j, std::size_t k) { // 01 02 03 12 13 23
        return j == 0 ? k - 1 : j + k;
    }
};

/// A simplex of dimension D on the boundary of a cell's prism, in local numbers.
template<int D>
using PrismPiece = std::array<std::uint8_t, D + 1>;

/// A cone from the centre of a cell's prism over the pieces of its boundary.
template<int D>
struct PrismCone {
    std::vector<PrismPiece<D>> pieces;
    /// Whether (the piece's corners, the centre) is negative, over a cell whose corners are in positive
    /// order.
    std::vector<std::uint8_t> odd;
    /// across[p][i]: the piece across the facet of piece p opposite to its corner i.
    std::vector<PrismPiece<D>> across;

    static constexpr std::size_t most_pieces = 128;
};

/// Orientation and adjacency of the pieces, from their corners' places in a prism of straight walls.
/// Returns false when the pieces do not close.
template<int D>
bool connect_cone(PrismCone<D>& cone);

} // namespace slabhull
