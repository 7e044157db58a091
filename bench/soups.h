// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"

#include <cstddef>
#include <filesystem>

namespace slabhull::bench {

enum class CellOrder {
    mesher, ///< as TetGen leaves them
    curve,  ///< the same mesh along a space-filling curve
};

struct Soup {
    CapMesh<3> mesh;
    std::size_t fixed = 0; ///< points of the boundary
};

/// TetGen's tetrahedra in a cube of edge 10 around a unit sphere of `divisions`, with the sphere's spacing
/// everywhere: some 4,070 divisions^3 of them. Made once per run: 5 microseconds for each.
const Soup& soup(int divisions, CellOrder order);

/// From now on soups are kept in this directory, and taken from it where an earlier run has left them.
void keep_soups_in(const std::filesystem::path& directory);

} // namespace slabhull::bench
