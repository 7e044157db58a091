// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/topology/boundary.h"
#include "slabhull/topology/prism_split.h"

#include <array>
#include <cstddef>

namespace slabhull {

/// The adjacency of the prisms of one layer, the same in every layer: the dual graph of the swept boundary,
/// and numbers for the quadrilaterals over its edges. Data of a facet hold for all prisms over it.
template<int D>
struct PrismGraph {
    /// A lateral face as the prism across sees it.
    struct TwinFace {
        std::uint8_t face; ///< its number in the prism across
        bool turned;       ///< the prism across has the face's two corners in the other order (D = 3)
    };
    static constexpr std::size_t quads_of_facet = std::tuple_size_v<Quads<D>>;

    Boundary<D> boundary;
    Array<std::array<TwinFace, D>> twin; ///< of each lateral face
    /// Numbers of the facet's quadrilaterals, in the order of Quads<D>. The centred ones come first.
    Array<std::array<Index, quads_of_facet>> quad;
    std::size_t quads = 0;
    std::size_t centred = 0;

    std::size_t facets() const { return boundary.facet_count(); }
    /// The facet across lateral face i.
    Index across(std::size_t facet, std::size_t i) const { return boundary.neighbors()[facet][i]; }
    bool is_centred(std::size_t facet, std::size_t q) const { return quad[facet][q] < centred; }
    /// Whether a facet is the first of the two beside a quadrilateral, which owns it.
    bool owns(std::size_t facet, std::size_t q) const { return D == 2 || boundary.owns(facet, q); }
};

/// Connects the prisms over a boundary and decides which quadrilaterals carry centres: for B and D by
/// a perfect matching of the facets, which depends on their order only and so is the same in every slab of a
/// march. Near-linear.
template<int D>
PrismGraph<D> connect_prisms(const Boundary<D>& boundary, const SplitRecipe& recipe);

} // namespace slabhull
