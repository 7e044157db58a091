// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"
#include "slab/fill/wall_split.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace slabhull {

/// The split of a hull's side, which the prisms inside must match. A wall is the prism that a facet of the
/// cap sweeps in a layer. A staircase is a wall or quadrilateral whose diagonals all rise; being the usual
/// split, it is not stored.
template<int D>
class SideWalls {
public:
    /// Throws GeometryError for a side that is not split as a hull's must be.
    SideWalls(const Hull<D>& hull, const SlabColumns<D>& columns);

    /// Whether all walls are staircases in every layer.
    bool all_staircases() const { return others_.empty(); }
    /// Whether the wall over a swept facet is a staircase in every layer.
    bool staircase(Index swept_facet) const { return staircase_[swept_facet] != 0; }
    /// The hull's cells in the wall over a swept facet: as many as `cells_per_wall()`, from this one.
    Index first_cell(std::size_t layer, Index swept_facet) const {
        return static_cast<Index>(hull_.initial_cells +
                                  (layer * hull_.facet_patch.size() + swept_facet) * hull_.cells_per_prism);
    }
    std::size_t cells_per_wall() const { return hull_.cells_per_prism; }
    const Hull<D>& hull() const { return hull_; }

    /// The number of the quadrilateral over the edge between columns a < b if it is on the side and, in some
    /// layer, not a staircase; else no_index. D = 3: for D = 2, a quadrilateral is a wall.
    Index quad(Index a, Index b) const;
    const QuadSplit& split(std::size_t layer, Index quad) const {
        return splits_[layer * edges_.size() + quad];
    }

private:
    void read_wall(std::size_t cell, std::size_t k);
    CellRange wall(std::size_t layer, Index facet) const {
        const Index first = first_cell(layer, facet);
        return {first, static_cast<Index>(first + cells_per_wall())};
    }
    void collect_edges();
    void require_alike() const;

    const Hull<D>& hull_;
    const SlabColumns<D>& columns_;
    Array<std::uint8_t> staircase_;
    std::vector<std::pair<Index, Facet<D>>> others_; ///< swept facets not staircases, their columns
    std::vector<std::array<Index, 2>> edges_;        ///< edges below quadrilaterals, ascending
    std::vector<QuadSplit> splits_;                  ///< by layer, then as edges_
};

extern template class SideWalls<2>;
extern template class SideWalls<3>;

} // namespace slabhull
