// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point_set.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace slabhull::io {

/// One of the pieces of a mesh, for whoever has that piece only: a range of its cells and the points that
/// these use.
struct PieceColumns {
    MeshColumns mesh;       ///< points and cells numbered within the piece; data of both; no groups
    std::size_t pieces = 1; ///< of the whole mesh
    std::size_t number = 0; ///< of this one, from 0

    // What is known of the whole mesh
    std::size_t all_cells = 0;
    std::size_t first_cell = 0;             ///< number of the piece's first cell
    std::shared_ptr<const PointSet> points; ///< which of the mesh's points the piece has
    std::vector<MeshColumns::Group> groups; ///< of all cells
    Point<3> lower_corner{};                ///< of the box around all points
    Point<3> upper_corner{};
};

} // namespace slabhull::io
