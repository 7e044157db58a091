// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/fill.h"

#include "slab/adapt/adapt_cap.h"
#include "slab/fill/cone_cells.h"
#include "slab/fill/describe_hull.h"
#include "slab/fill/inner_places.h"
#include "slab/fill/mend_cells.h"
#include "slab/fill/side_walls.h"
#include "slab/fill/slab_columns.h"
#include "slab/fill/staircase.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t prisms_per_fill = 1 << 12;

/// Makes the cells.
template<int D>
class CellMaker {
public:
    CellMaker(const SlabColumns<D>& columns, const ConeCells<D>& cones, Filling<D>& filling)
        : columns_{columns}, cones_{cones}, filling_{filling} {}

    void run() {
        const std::size_t count = columns_.layers() * cones_.cells_per_layer();
        checked_index(count, "cells of the filling");
        filling_.cells.resize(count);
        filling_.neighbors.resize(count);
        const std::size_t prisms = columns_.cells.size();
        parallel_for(columns_.layers() * prisms, prisms_per_fill, [&](std::size_t begin, std::size_t end) {
            PrismCone<D> cone;
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t layer = k / prisms;
                const auto cell = static_cast<Index>(k % prisms);
                if (cones_.is_cone(cell)) {
                    place_cone(layer, cell, cone);
                } else {
                    for (std::size_t m = 0; m <= D; ++m) {
                        place_stair(layer, cell, m);
                    }
                }
            }
        });
    }

private:
    /// Places piece m of a staircase.
    void place_stair(std::size_t layer, Index cell, std::size_t m) {
        Simplex<D + 1> piece = staircase_piece<D>(columns_, layer, columns_.cells[cell], m);
        Neighbors<D + 1> across;
        for (std::size_t i = 0; i <= D + 1; ++i) {
            if (i == m) {
                across[i] = m == 0 ? above(layer, cell) : number(layer, cell, m - 1);
            } else if (i == m + 1) {
                across[i] = m == D ? below(layer, cell) : number(layer, cell, m + 1);
            } else {
                const std::size_t corner = i < m ? i : i - 1;
                across[i] = across_wall(layer, cell, corner, m < corner ? m : m - 1);
            }
        }
        const bool even = (D - m) % 2 == 0; // parity, if the cell's columns are in positive order
        put(number(layer, cell, m), piece, across, even == (columns_.odd[cell] != 0));
    }

    void place_cone(std::size_t layer, Index cell, PrismCone<D>& cone) {
        const auto vertex = cones_.make(layer, cell, cone);
        for (std::size_t p = 0; p < cone.pieces.size(); ++p) {
            Simplex<D + 1> piece;
            Neighbors<D + 1> across;
            for (std::size_t i = 0; i <= D; ++i) {
                piece[i] = vertex[cone.pieces[p][i]];
                across[i] = number(layer, cell, cone.across[p][i]);
            }
            piece[D + 1] = vertex[CellPrismPoint<D>::centre];
            across[D + 1] = across_piece(layer, cell, p);
            put(number(layer, cell, p), piece, across, cone.odd[p] != columns_.odd[cell]);
        }
    }

    void put(Index number, Simplex<D + 1> cell, Neighbors<D + 1> across, bool odd) {
        if (odd) {
            std::swap(cell[0], cell[1]);
            std::swap(across[0], across[1]);
        }
        filling_.cells[number] = cell;
        filling_.neighbors[number] = across;
    }

    Index number(std::size_t layer, Index cell, std::size_t piece) const {
        return static_cast<Index>(layer * cones_.cells_per_layer() + cones_.first(cell) + piece);
    }

    /// The simplex across the top of a cell's prism, in the next layer; no_index in the last layer.
    Index above(std::size_t layer, Index cell) const {
        return layer + 1 == columns_.layers() ? no_index
                                              : number(layer + 1, cell, cones_.is_cone(cell) ? 0 : D);
    }
    Index below(std::size_t layer, Index cell) const {
        return layer == 0 ? no_index : number(layer - 1, cell, cones_.is_cone(cell) ? 1 : 0);
    }

    /// The simplex across piece m of the wall opposite to a corner.
    Index across_wall(std::size_t layer, Index cell, std::size_t corner, std::size_t m) const {
        const Index other = columns_.neighbors[cell][corner];
        if (other == no_index) {
            return no_index;
        }
        const auto& back = columns_.neighbors[other];
        const auto place = static_cast<std::size_t>(std::find(back.begin(), back.end(), cell) - back.begin());
        return number(layer, other,
                      cones_.is_cone(other) ? cones_.wall_begin(other, place) + m : piece_at_wall(m, place));
    }

    /// The simplex across piece p of a cone: below, above, or across a wall.
    Index across_piece(std::size_t layer, Index cell, std::size_t p) const {
        if (p < 2) {
            return p == 0 ? below(layer, cell) : above(layer, cell);
        }
        std::size_t corner = 0;
        while (p >= cones_.wall_begin(cell, corner + 1)) {
            ++corner;
        }
        return across_wall(layer, cell, corner, p - cones_.wall_begin(cell, corner));
    }

    const SlabColumns<D>& columns_;
    const ConeCells<D>& cones_;
    Filling<D>& filling_;
};

/// Adds facets, attributes, ids and tracks: those of the hull, and the tracks of inner vertices.
template<int D>
void describe(const Hull<D>& hull, const SlabColumns<D>& columns, Filling<D>& filling) {
    describe_hull(hull, filling);
    for (std::size_t level = 1; level < columns.layers(); ++level) {
        for (Index k = 0; k < columns.count; ++k) {
            if (columns.on_boundary[k] == 0) {
                filling.track_ids.push_back(hull.track_ids[columns.at(0, k)]);
            }
        }
    }
    filling.track_ids.append_run(no_track, filling.steiner_points, 0);
}

} // namespace

template<int D>
Filling<D> fill_slab(const Hull<D>& hull, StageClock& clock) {
    if (hull.boundary_changes()) {
        throw GeometryError{
            "the hull's side is not made of equal prisms: a slab whose boundary changes its "
            "connectivity ([adapt] boundary) is filled as it is built, by [fill] in its case"};
    }
    if (!hull.adapt_settings.empty()) {
        const AdaptLog<D> log = log_of_hull(hull);
        clock.book("adapting the cap again");
        return fill_adapted(hull, log, clock);
    }
    Filling<D> filling;
    const SlabColumns<D> columns = slab_columns(hull, filling);
    clock.book("cap pairing");
    place_inside(hull, columns, filling);
    clock.book("inner places");
    const SideWalls<D> walls{hull, columns};
    const ConeCells<D> cones{columns, walls, filling};
    CellMaker<D>{columns, cones, filling}.run();
    describe(hull, columns, filling);
    clock.book("filling");
    std::vector<Index> bad = not_positive(filling);
    if (!bad.empty()) {
        bad = mend_cells(std::move(bad), columns.cells.size(), columns.layers(), filling);
    }
    if (!bad.empty()) {
        refuse_cells(bad, filling, columns, cones);
    }
    clock.book("signs");
    return filling;
}

template<int D>
Filling<D> fill_slab(const Hull<D>& hull) {
    StageClock clock;
    return fill_slab(hull, clock);
}

template Filling<2> fill_slab<2>(const Hull<2>&, StageClock&);
template Filling<3> fill_slab<3>(const Hull<3>&, StageClock&);
template Filling<2> fill_slab<2>(const Hull<2>&);
template Filling<3> fill_slab<3>(const Hull<3>&);

} // namespace slabhull
