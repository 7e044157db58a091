// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"
#include "slab/fill/wall_split.h"
#include "slabhull/topology/hull.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// The hull's side in one layer, as what is inside must match it: the cells over each facet of the cap's
/// boundary, and the quadrilaterals over its edges. A quadrilateral whose diagonal rises is the usual one,
/// and not stored.
template<int D>
class LayerSide {
public:
    /// The hull's cells that a facet of the cap at the layer's start belongs to.
    struct Wall {
        Facet<D> facet; ///< columns, ascending
        CellRange cells;
        bool staircase;
    };

    /// `column`: of each of the hull's vertices, no_index for centres and apexes. `cells`: the layer's.
    /// Throws GeometryError for a side that is not split as a hull's must be.
    LayerSide(const Hull<D>& hull, const SlabColumns<D>& columns, std::span<const Index> column,
              std::size_t layer, const CellRange& cells);

    /// Whether all facets and quadrilaterals are staircases.
    bool all_staircases() const { return others_ == 0 && quads_.empty(); }
    /// Null for a facet inside.
    const Wall* wall(const Facet<D>& sorted) const;
    /// The split of the quadrilateral over the edge between columns a < b; null for the usual one. D = 3: for
    /// D = 2, a quadrilateral is a wall.
    const QuadSplit* quad(Index a, Index b) const;
    const Hull<D>& hull() const { return hull_; }

private:
    void read_part(const CellRange& cells);
    std::vector<Facet<D>> facets_below(const CellRange& cells) const;
    void read_quads(const CellRange& cells, const std::vector<Facet<D>>& facets);

    const Hull<D>& hull_;
    const SlabColumns<D>& columns_;
    std::span<const Index> column_;
    std::size_t layer_;
    std::vector<Wall> walls_; ///< by facet
    std::size_t others_ = 0;  ///< number of walls that are not staircases
    std::vector<std::pair<std::array<Index, 2>, QuadSplit>> quads_; ///< by edge
};

extern template class LayerSide<2>;
extern template class LayerSide<3>;

} // namespace slabhull
