// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/hull_view.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/topology/partial_stars.h"

#include <cstdint>

namespace slabhull {

/// What a part of a hull lacks for whole stars: one layer of ghosts, the cells of other parts at vertices
/// that this rank owns. The owner of a vertex is the lowest rank that uses it.
template<int D>
struct PartStars {
    /// Ascending by their numbers in the hull. Their vertices are the part's, then those of ghosts alone.
    Array<Simplex<D>> ghosts;
    Array<Neighbors<D>> ghost_neighbors; ///< the part's cells, then ghosts; no_index for others
    Array<std::uint8_t> ghost_region;
    Array<Index> outside;      ///< what the cells of HullPart::outside are here: ghosts, or no_index
    Array<std::uint8_t> owned; ///< of each vertex: whether this rank owns it

    PartialMesh<D> mesh_with(const HullPart<D>& part) const {
        return {part.cells, part.neighbors, outside, ghosts, ghost_neighbors, owned};
    }
    /// Calls visit(cell, region) for the cells of the part and the ghosts.
    template<class Visit>
    void each_cell(const HullView<D>& view, const Visit& visit) const {
        for (std::size_t c = 0; c < view.cells().size(); ++c) {
            visit(view.cells()[c], view.region_of(c));
        }
        for (std::size_t g = 0; g < ghosts.size(); ++g) {
            visit(ghosts[g], static_cast<Region>(ghost_region[g]));
        }
    }
};

/// Completes the stars of the vertices that each rank owns. `view` has the regions of the part's cells.
/// Collective. Cost: linear; what is sent grows with the boundaries between parts, but for 8 bytes of each
/// point.
template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const HullView<D>& view, Communicator& ranks);

} // namespace slabhull
