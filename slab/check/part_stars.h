// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"

#include <cstdint>

namespace slabhull {

/// A part of a hull with one layer of ghosts: the cells of other parts at vertices that this rank owns. The
/// owner of a vertex is the lowest rank that uses it.
template<int D>
struct PartStars {
    /// The part's cells, then ghosts, ascending by their numbers in the hull. Their vertices are the part's,
    /// then those of ghosts alone.
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors; ///< among these cells; no_index for others
    Array<std::uint8_t> region;    ///< of these cells
    Array<std::uint8_t> owned;     ///< of each vertex: whether this rank owns it
};

/// Completes the stars of the vertices that each rank owns. `region` are those of the part's cells.
/// Collective. Cost: linear; what is sent grows with the boundaries between parts, but for 16 bytes of
/// each point.
template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const Array<std::uint8_t>& region, Communicator& ranks);

} // namespace slabhull
