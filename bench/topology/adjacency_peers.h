// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

// In C++17: VTK 9.1's headers are not C++20.

namespace slabhull::bench {

using Quad = std::array<std::uint32_t, 4>; ///< Simplex<3>, Neighbors<3>
inline constexpr std::uint32_t no_cell = UINT32_MAX;

struct TetSoup {
    const std::array<double, 3>* points;
    std::size_t point_count;
    const Quad* cells;
    std::size_t cell_count;
};

/// Another library's way to the neighbours of a soup.
struct Peer {
    /// Writes result[c][i], the cell across the facet of c opposite to its vertex i, or no_cell. This is
    /// timed.
    using Find = std::function<void(Quad* result)>;
    std::string name;
    int divisions; ///< of the largest soup that takes less than a minute
    /// The soup in the form that the library starts from. This is not timed. The soup stays.
    Find (*prepare)(const TetSoup& soup);
};

/// Each peer's .cpp adds its own, where its library is installed.
inline std::vector<Peer>& peers() {
    static std::vector<Peer> all;
    return all;
}

inline bool add_peer(Peer peer) {
    peers().push_back(std::move(peer));
    return true;
}

/// The place in `cell` of the vertex that is not on the facet of `other` opposite to its vertex `i`.
inline std::size_t place_across(const Quad& cell, const Quad& other, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (cell[k] != other[(i + 1) % 4] && cell[k] != other[(i + 2) % 4] && cell[k] != other[(i + 3) % 4]) {
            return k;
        }
    }
    return 3;
}

} // namespace slabhull::bench
