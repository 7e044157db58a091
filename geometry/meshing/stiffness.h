// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull::detail {

/// The stiffness matrix K of linear elements for div(kappa grad u) = 0, kappa one number per cell: the square
/// of sum_i |grad lambda_i|^2 over its barycentric coordinates. So kappa falls with the fourth power of the
/// cell's size, and rises with the fourth of its flatness: small and flat cells are carried along, large
/// round ones give way.
///
/// Scaled to a unit diagonal, K_ij / sqrt(K_ii K_jj), in single precision. There are rows for the free
/// vertices only; the fixed ones enter with K_jj = 1. Lengths are in units of the mean cell's.
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

/// `fixed` is 1 for fixed vertices and 0 for free ones.
/// Needs: positive cells, which around a free vertex fill a ball.
/// Throws GeometryError naming a free vertex around which they do not.
/// Cost: linear. The same for any number of threads.
template<int D>
Stiffness assemble_stiffness(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                             std::span<const std::uint8_t> fixed);

} // namespace slabhull::detail
