// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace slabhull {

/// Some cells of a mesh: all that have one of the wanted vertices, and perhaps others.
template<int D>
struct PartialMesh {
    std::span<const Simplex<D>> cells;
    std::span<const Neighbors<D>> neighbors; ///< no_index for cells that are not here
    std::span<const std::uint8_t> wanted;    ///< of each vertex, whether its star is to be examined
};

struct StarCounts {
    std::size_t vertices = 0;      ///< wanted ones
    std::size_t link_vertices = 0; ///< over their links
};

/// Whether the star of every wanted vertex is that of a closed oriented manifold: what confirm_manifold()
/// proves of a whole mesh, vertex by vertex, so that parts whose wanted vertices are together all vertices
/// prove it of the mesh. Nothing is trusted: each facet with a wanted vertex is compared with what is said to
/// be across it. Empty where it is not so, for whatever reason. Cost: linear; 8 bytes per vertex.
template<int D>
std::optional<StarCounts> confirm_stars(const PartialMesh<D>& mesh);

} // namespace slabhull
