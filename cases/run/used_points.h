// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases/run/mesh_soup.h"

#include <span>
#include <vector>

namespace slabhull {

/// The points that some simplices use, in their order, and the way from the soup's numbers to theirs.
template<int D>
struct UsedPoints {
    Array<Point<D>> points;
    std::vector<Index> number; ///< of each soup point; no_index when unused

    UsedPoints(const io::Soup& soup, std::span<const Index> vertices) : number(soup.points.size(), no_index) {
        for (const Index v : vertices) {
            number[v] = 0;
        }
        for (std::size_t v = 0; v < number.size(); ++v) {
            if (number[v] == 0) {
                number[v] = static_cast<Index>(points.size());
                points.push_back(point_in_space<D>(soup, v));
            }
        }
    }
};

template<int K>
Array<Simplex<K>> renumbered(const io::SimplexBlock& block, const std::vector<Index>& number) {
    Array<Simplex<K>> simplices(block.size(K));
    for (std::size_t i = 0; i < simplices.size(); ++i) {
        for (std::size_t k = 0; k <= K; ++k) {
            simplices[i][k] = number[block.vertices[i * (K + 1) + k]];
        }
    }
    return simplices;
}

} // namespace slabhull
