// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/prism_cone.h"
#include "slab/fill/side_walls.h"
#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

#include <vector>

namespace slabhull {

/// The cells of the cap whose prisms are not staircases, because a wall or quadrilateral that they share with
/// the side is not one. Each prism is coned from its centre, and so are its inner walls with such a
/// quadrilateral. The cells are the same in every layer.
///
/// A cone's pieces: the cell below, the cell above, then the walls in the order of their opposite corners.
template<int D>
class ConeCells {
public:
    /// Appends the centres to the points of the filling, layer by layer: those of walls, then of cells.
    ConeCells(const SlabColumns<D>& columns, const SideWalls<D>& walls, Filling<D>& filling);

    bool is_cone(Index cell) const { return !cone_of_.empty() && cone_of_[cell] != no_index; }
    /// The first of a cell's simplices in its layer.
    std::size_t first(Index cell) const {
        return first_.empty() ? std::size_t{cell} * (D + 1) : first_[cell];
    }
    std::size_t cells_per_layer() const { return first(static_cast<Index>(columns_.cells.size())); }
    /// The first piece of the wall opposite to a corner of a cone; one past the last for corner D + 1.
    std::size_t wall_begin(Index cell, std::size_t corner) const {
        return cones_[cone_of_[cell]].wall_begin[corner];
    }
    /// The cap's cell whose prism contains a simplex of a layer.
    Index cell_of(std::size_t simplex) const;

    using Vertices = std::array<Index, CellPrismPoint<D>::count>;
    /// Makes the cone over a cell; returns the filling's vertices by local numbers.
    /// Throws GeometryError when the walls do not close.
    Vertices make(std::size_t layer, Index cell, PrismCone<D>& cone) const;

private:
    struct Cone {
        Index cell;
        std::array<Index, D + 1> wall_centre; ///< number of the centre in a layer; no_index: none
        std::array<std::uint16_t, D + 2> wall_begin;
    };

    bool meets_other_split(Index cell) const;
    void number_walls(Cone& cone);
    bool has_centre(Index cell, std::size_t corner) const;
    std::size_t wall_pieces(const Cone& cone, std::size_t corner) const;
    void place_centres(Filling<D>& filling);
    std::size_t wall_centre(std::size_t layer, Index number) const {
        return centres_begin_ + layer * (wall_centres_ + cones_.size()) + number;
    }
    std::size_t cell_centre(std::size_t layer, Index cell) const {
        return wall_centre(layer, 0) + wall_centres_ + cone_of_[cell];
    }

    void add_staircase(std::size_t corner, PrismCone<D>& cone) const;
    void add_side(std::size_t layer, Index cell, std::size_t corner, Vertices& vertex,
                  PrismCone<D>& cone) const;
    void add_coned_wall(std::size_t layer, Index cell, std::size_t corner, PrismCone<D>& cone) const;
    void add_quad(std::size_t layer, Index cell, std::uint8_t wall, std::size_t j, std::size_t k,
                  PrismCone<D>& cone) const;

    const SlabColumns<D>& columns_;
    const SideWalls<D>& walls_;
    std::vector<Cone> cones_;
    Array<Index> cone_of_; ///< cone of each cell; empty without cones
    Array<Index> first_;   ///< first simplex of each cell; empty without cones
    std::size_t wall_centres_ = 0;
    std::size_t centres_begin_ = 0;
};

extern template class ConeCells<2>;
extern template class ConeCells<3>;

} // namespace slabhull
