// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull::detail {

/// The stiffness matrix K of linear elements for div(kappa grad u) = 0 with kappa constant per cell: the
/// square of sum_i |grad lambda_i|^2 over its barycentric coordinates. So kappa falls with the fourth power
/// of the cell's size, and rises with the fourth of its flatness: small and flat cells move almost rigidly,
/// large round ones deform.
///
/// Scaled to a unit diagonal, K_ij / sqrt(K_ii K_jj), in single precision. Only free vertices have rows;
/// fixed ones enter with K_jj = 1. The unit of length is the mean cell's.
struct Stiffness {
    struct Entry {
        Index column;
        float value;
    };
    Array<std::size_t>
        first; ///< row v: entries first[v] to first[v + 1] without the diagonal; empty if fixed
    Array<Entry> entries;
    Array<float> root; ///< sqrt(K_vv); 1 for a fixed vertex

    std::span<const Entry> row(std::size_t v) const {
        return {entries.data() + first[v], first[v + 1] - first[v]};
    }
    bool is_free(std::size_t v) const { return first[v] != first[v + 1]; }
};

/// `fixed`: 1 for fixed vertices and 0 for free ones.
/// Needs: positive cells that fill a ball around each free vertex.
/// Throws GeometryError naming a free vertex around which they do not.
/// Cost: linear. The same for any number of threads.
template<int D>
Stiffness assemble_stiffness(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                             std::span<const std::uint8_t> fixed);

} // namespace slabhull::detail
