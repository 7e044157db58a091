// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// A mesh as StarConfirmation and StarCounter look at one; PartialMesh is another.
template<int D>
struct WholeMesh {
    std::span<const Simplex<D>> cells;
    std::span<const Neighbors<D>> neighbors;
    std::size_t vertices = 0; ///< where it is asked for

    std::size_t size() const { return cells.size(); }
    std::size_t vertex_count() const { return vertices; }
    bool is_wanted(Index) const { return true; }
    const Simplex<D>& cell(Index c) const { return cells[c]; }
    Index neighbor(Index c, std::size_t i) const { return neighbors[c][i]; }
    /// Prefetches a cell that is looked at soon.
    void prefetch(Index c) const {
        __builtin_prefetch(&cells[c]);
        __builtin_prefetch(&neighbors[c]);
    }
};

} // namespace slabhull
