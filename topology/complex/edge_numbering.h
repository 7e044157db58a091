// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// The six edges of a tetrahedron, by local vertices.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tetrahedron_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Where the edge of local vertices i and j is in tetrahedron_edges.
constexpr std::size_t tetrahedron_edge(std::size_t i, std::size_t j) {
    const std::size_t low = i < j ? i : j;
    return low == 0 ? i + j - 1 : i + j;
}

/// Numbers for the edges of a closed 3-manifold.
struct EdgeNumbering {
    std::size_t count = 0;
    Array<std::array<Index, 6>> of_cell; ///< in the order of tetrahedron_edges
};

/// Edges are numbered by their smaller vertex, so neighbouring edges have close numbers. Parallel and
/// deterministic.
EdgeNumbering number_edges(std::span<const Simplex<3>> cells, std::size_t vertex_count,
                           std::span<const Neighbors<3>> neighbors);

} // namespace slabhull
