// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace slabhull {

// How a level of time cuts a cell. A simplex with some vertices below the level and the others above it is
// cut in the product of two simplices: one point for each edge from below to above. Staircase paths through
// the grid of these points triangulate the product (Eilenberg and Zilber, American Journal of Mathematics 75,
// 1953): a segment for D = 2; a triangle, or a quadrilateral in two triangles, for D = 3.

/// The point where a level crosses an edge of a cell, by the local numbers of the edge's ends.
struct CutCorner {
    std::uint8_t lower = 0;
    std::uint8_t upper = 0;
};

/// The section of a D-simplex at a level: simplices of dimension D - 1.
template<int D>
struct CellCut {
    static constexpr std::size_t most = D == 3 ? 2 : 1;
    std::size_t count = 0;
    std::array<std::array<CutCorner, D>, most> facets{};
};

namespace cut_detail {

template<int D>
using Matrix = std::array<std::array<int, D + 1>, D + 1>;

/// Determinant by Leibniz's formula.
template<int D>
constexpr int determinant(const Matrix<D>& rows) {
    std::array<std::size_t, D + 1> column{};
    std::iota(column.begin(), column.end(), std::size_t{0});
    int sum = 0;
    do {
        int product = 1;
        for (std::size_t i = 0; i <= D; ++i) {
            product *= rows[i][column[i]];
            for (std::size_t j = 0; j < i; ++j) {
                product *= column[j] < column[i] ? 1 : -1;
            }
        }
        sum += product;
    } while (std::next_permutation(column.begin(), column.end()));
    return sum;
}

/// Sign of the simplex of a facet and a point above it, in barycentric coordinates of the cell.
template<int D>
constexpr int orientation(const std::array<CutCorner, D>& facet) {
    Matrix<D> rows{};
    for (std::size_t i = 0; i < D; ++i) {
        rows[i][facet[i].lower] += 1;
        rows[i][facet[i].upper] += 1;
    }
    rows[D][facet[0].upper] = 1;
    return determinant<D>(rows);
}

/// The section by the vertices above the level: bit i of `upper` for vertex i.
template<int D>
constexpr CellCut<D> cut_of(unsigned upper) {
    std::array<std::uint8_t, D + 1> below{};
    std::array<std::uint8_t, D + 1> above{};
    std::size_t lower_count = 0;
    std::size_t upper_count = 0;
    for (unsigned i = 0; i <= D; ++i) {
        const bool is_above = (upper >> i & 1u) != 0;
        (is_above ? above[upper_count++] : below[lower_count++]) = static_cast<std::uint8_t>(i);
    }
    CellCut<D> cut;
    for (unsigned path = 0; lower_count > 0 && path < 1u << (D - 1);
         ++path) { // bit k: step k changes `above`
        if (static_cast<std::size_t>(std::popcount(path)) + 1 != upper_count) {
            continue;
        }
        std::array<CutCorner, D>& facet = cut.facets[cut.count++];
        for (std::size_t k = 0, i = 0, j = 0; k < D; ++k) {
            facet[k] = {below[i], above[j]};
            (path >> k & 1u) != 0 ? ++j : ++i;
        }
        // Outward from the slab and outward from its section are the same side of a facet. With f the facet's
        // edges, n its outward normal in space, N the cell's and u a direction of the cell that rises:
        // det[f .., u, N] has the sign of -det[f .., n], as u and N span the same plane as n and time.
        if (orientation<D>(facet) > 0) {
            std::swap(facet[0], facet[1]);
        }
    }
    return cut;
}

template<int D>
constexpr std::array<CellCut<D>, 1u << (D + 1)> make_table() {
    std::array<CellCut<D>, 1u << (D + 1)> table{};
    for (unsigned upper = 0; upper < table.size(); ++upper) {
        table[upper] = cut_of<D>(upper);
    }
    return table;
}

} // namespace cut_detail

/// Sections by the set of vertices above the level, bit i for vertex i of a hull's cell. Facets are outward
/// from the domain, as those of Surface<D>.
template<int D>
inline constexpr auto cut_table = cut_detail::make_table<D>();

} // namespace slabhull
