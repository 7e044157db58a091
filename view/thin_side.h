// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/slab/check.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace slabhull {

/// A hull's side with fewer cells: some of its levels, and between them prisms in D cells each.
template<int D>
struct ThinSide {
    Array<Point<D + 1>> points;
    Array<Simplex<D>> cells;  ///< oriented as the hull's
    Array<PatchNumber> patch; ///< of cells
    Array<std::int64_t> vertex_id, track_id;
    std::size_t levels = 0;     ///< kept
    std::size_t all_levels = 0; ///< of the hull
};

/// Keeps as many levels as `most` cells allow, evenly and at least the first and the last. On them the
/// section is exactly the hull's; between them vertices move in straight lines. Nothing where this cannot be:
/// without tracks, or when the boundary's connectivity changes within the slab. Throws what slice_hull()
/// throws.
template<int D>
std::optional<ThinSide<D>> thin_side(const HullColumns<D>& hull, std::size_t most);

} // namespace slabhull
