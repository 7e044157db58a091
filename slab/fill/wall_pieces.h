// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/layer_side.h"
#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

#include <map>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// How walls, the prisms that facets of the cap sweep in a layer, are divided into simplices: those on the
/// side as the hull is; those inside by staircases, or coned from a centre where a quadrilateral that they
/// share with the side is not a staircase (D = 3).
template<int D>
class WallPieces {
public:
    /// Centres of walls are appended to the points of the filling.
    WallPieces(const SlabColumns<D>& columns, Filling<D>& filling) : columns_{columns}, filling_{filling} {}

    /// Starts a layer with this side, which must outlive it.
    void enter(const LayerSide<D>& side) {
        side_ = &side;
        centres_.clear();
    }

    /// Whether the prism over a cell of the cap meets a wall or quadrilateral of the side that is no
    /// staircase.
    bool meets_other_split(const Simplex<D>& cell) const;

    /// Appends the pieces of the walls over some facets, which are outward: outward pieces.
    void append(std::size_t layer, std::span<const Facet<D>> facets, std::vector<Simplex<D>>& pieces);

private:
    void append_staircase(std::size_t layer, const Facet<D>& sorted, bool odd,
                          std::vector<Simplex<D>>& pieces) const;
    void append_cone(std::size_t layer, const Facet<D>& sorted, bool odd, std::vector<Simplex<D>>& pieces);
    Index centre(std::size_t layer, const Facet<D>& sorted);

    const LayerSide<D>* side_ = nullptr;
    const SlabColumns<D>& columns_;
    Filling<D>& filling_;
    std::map<Facet<D>, Index> centres_; ///< of the layer's walls
};

extern template class WallPieces<2>;
extern template class WallPieces<3>;

} // namespace slabhull
