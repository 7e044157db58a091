// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/cone_cells.h"

#include "slab/fill/staircase.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace slabhull {

namespace {

constexpr std::size_t cones_per_piece = 1 << 10;

/// The mean place of some columns on two levels.
template<int D, std::size_t N>
Point<D + 1> mean_of_columns(const SlabColumns<D>& columns, const Filling<D>& filling, std::size_t layer,
                             const std::array<Index, N>& corners) {
    Point<D + 1> mean{};
    for (const std::size_t level : {layer, layer + 1}) {
        for (const Index column : corners) {
            for (std::size_t k = 0; k < D; ++k) {
                mean[k] += filling.points[columns.at(level, column)][k];
            }
        }
    }
    for (double& coordinate : mean) {
        coordinate /= 2.0 * static_cast<double>(N);
    }
    mean[D] = 0.5 * (columns.times[layer] + columns.times[layer + 1]);
    return mean;
}

} // namespace

template<int D>
ConeCells<D>::ConeCells(const SlabColumns<D>& columns, const SideWalls<D>& walls, Filling<D>& filling)
    : columns_{columns}, walls_{walls}, centres_begin_{filling.points.size()} {
    for (Index c = 0; !walls.all_staircases() && c < columns.cells.size(); ++c) {
        if (meets_other_split(c)) {
            cones_.push_back({c, {}, {}});
        }
    }
    if (cones_.empty()) {
        return;
    }
    cone_of_.assign(columns.cells.size(), no_index);
    for (std::size_t k = 0; k < cones_.size(); ++k) {
        cone_of_[cones_[k].cell] = static_cast<Index>(k);
    }
    for (Cone& cone : cones_) {
        number_walls(cone);
    }
    std::size_t next = 0;
    first_.resize(columns.cells.size() + 1);
    for (Index c = 0; c < columns.cells.size(); ++c) {
        first_[c] = checked_index(next, "cells of the filling");
        next += is_cone(c) ? cones_[cone_of_[c]].wall_begin[D + 1] : D + 1;
    }
    first_.back() = checked_index(next, "cells of the filling");
    place_centres(filling);
}

template<int D>
bool ConeCells<D>::meets_other_split(Index cell) const {
    for (std::size_t k = 0; k <= D; ++k) {
        const Index facet = columns_.swept_facet[cell][k];
        if (facet != no_index && !walls_.staircase(facet)) {
            return true;
        }
        for (std::size_t j = 0; D == 3 && j < k; ++j) {
            if (walls_.quad(columns_.cells[cell][j], columns_.cells[cell][k]) != no_index) {
                return true;
            }
        }
    }
    return false;
}

/// Whether the wall opposite to a corner is inside and has a quadrilateral that is not a staircase.
template<int D>
bool ConeCells<D>::has_centre(Index cell, std::size_t corner) const {
    if (D == 2 || columns_.neighbors[cell][corner] == no_index) {
        return false;
    }
    const Facet<D> facet = without<D>(columns_.cells[cell], corner);
    for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t j = 0; j < k; ++j) {
            if (walls_.quad(facet[j], facet[k]) != no_index) {
                return true;
            }
        }
    }
    return false;
}

/// A wall is numbered by the first of its two cells; the second takes over the number.
template<int D>
void ConeCells<D>::number_walls(Cone& cone) {
    std::size_t next = 2;
    for (std::size_t k = 0; k <= D; ++k) {
        cone.wall_centre[k] = no_index;
        if (has_centre(cone.cell, k)) {
            const Index other = columns_.neighbors[cone.cell][k];
            const auto& back = columns_.neighbors[other];
            const auto place = std::find(back.begin(), back.end(), cone.cell) - back.begin();
            cone.wall_centre[k] = other < cone.cell
                                      ? cones_[cone_of_[other]].wall_centre[static_cast<std::size_t>(place)]
                                      : checked_index(wall_centres_++, "vertices of the filling");
        }
        cone.wall_begin[k] = static_cast<std::uint16_t>(next);
        next += wall_pieces(cone, k);
    }
    cone.wall_begin[D + 1] = static_cast<std::uint16_t>(next);
}

template<int D>
std::size_t ConeCells<D>::wall_pieces(const Cone& cone, std::size_t corner) const {
    const Index facet = columns_.swept_facet[cone.cell][corner];
    if (facet != no_index && !walls_.staircase(facet)) {
        return walls_.cells_per_wall();
    }
    if (cone.wall_centre[corner] == no_index) {
        return D;
    }
    std::size_t count = 2;
    const Facet<D> corners = without<D>(columns_.cells[cone.cell], corner);
    for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t j = 0; j < k; ++j) {
            const Index quad = walls_.quad(corners[j], corners[k]);
            count += quad == no_index ? 2 : walls_.split(0, quad).pieces();
        }
    }
    return count;
}

template<int D>
void ConeCells<D>::place_centres(Filling<D>& filling) {
    filling.steiner_points = columns_.layers() * (wall_centres_ + cones_.size());
    checked_index(centres_begin_ + filling.steiner_points, "vertices of the filling");
    filling.points.resize(centres_begin_ + filling.steiner_points);
    for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
        parallel_for(cones_.size(), cones_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                const Cone& cone = cones_[n];
                const Simplex<D>& corners = columns_.cells[cone.cell];
                filling.points[cell_centre(layer, cone.cell)] =
                    mean_of_columns(columns_, filling, layer, corners);
                for (std::size_t k = 0; k <= D; ++k) {
                    if (cone.wall_centre[k] != no_index && cone.cell < columns_.neighbors[cone.cell][k]) {
                        filling.points[wall_centre(layer, cone.wall_centre[k])] =
                            mean_of_columns(columns_, filling, layer, without<D>(corners, k));
                    }
                }
            }
        });
    }
}

template<int D>
Index ConeCells<D>::cell_of(std::size_t simplex) const {
    if (first_.empty()) {
        return static_cast<Index>(simplex / (D + 1));
    }
    return static_cast<Index>(std::upper_bound(first_.begin(), first_.end(), simplex) - first_.begin() - 1);
}

template<int D>
typename ConeCells<D>::Vertices ConeCells<D>::make(std::size_t layer, Index cell, PrismCone<D>& cone) const {
    using Local = CellPrismPoint<D>;
    Vertices vertex;
    vertex.fill(no_index);
    const Cone& here = cones_[cone_of_[cell]];
    const Simplex<D>& corners = columns_.cells[cell];
    cone.pieces.assign(2, {});
    for (std::size_t k = 0; k <= D; ++k) {
        vertex[Local::below(k)] = columns_.at(layer, corners[k]);
        vertex[Local::above(k)] = columns_.at(layer + 1, corners[k]);
        cone.pieces[0][k] = Local::below(k);
        cone.pieces[1][k] = Local::above(k);
        for (std::size_t j = 0; D == 3 && j < k; ++j) {
            const Index quad = walls_.quad(corners[j], corners[k]);
            vertex[Local::quad_centre(j, k)] = quad == no_index ? no_index : walls_.split(layer, quad).centre;
        }
        if (here.wall_centre[k] != no_index) {
            vertex[Local::wall_centre(k)] = static_cast<Index>(wall_centre(layer, here.wall_centre[k]));
        }
    }
    vertex[Local::centre] = static_cast<Index>(cell_centre(layer, cell));
    for (std::size_t k = 0; k <= D; ++k) {
        const Index facet = columns_.swept_facet[cell][k];
        if (facet != no_index && !walls_.staircase(facet)) {
            add_side(layer, cell, k, vertex, cone);
        } else if (here.wall_centre[k] != no_index) {
            add_coned_wall(layer, cell, k, cone);
        } else {
            add_staircase(k, cone);
        }
    }
    if (!connect_cone<D>(cone)) {
        throw GeometryError{
            fmt::format("the hull's side beside cell {} does not close in layer {}; check the "
                        "hull first",
                        cell, layer),
            {{"cell", cell, {}}, {"layer", static_cast<std::int64_t>(layer), {}}}};
    }
    return vertex;
}

template<int D>
void ConeCells<D>::add_staircase(std::size_t corner, PrismCone<D>& cone) const {
    for (std::size_t m = 0; m < D; ++m) {
        PrismPiece<D> piece;
        for (std::size_t i = 0; i <= D; ++i) {
            const std::size_t k = i <= m ? i : i - 1; // corner of the wall
            const std::size_t at = k < corner ? k : k + 1;
            piece[i] = i <= m ? CellPrismPoint<D>::below(at) : CellPrismPoint<D>::above(at);
        }
        cone.pieces.push_back(piece);
    }
}

/// Adds the hull's cells in a wall. A vertex that is neither a corner nor a quadrilateral's centre is the
/// wall's centre.
template<int D>
void ConeCells<D>::add_side(std::size_t layer, Index cell, std::size_t corner, Vertices& vertex,
                            PrismCone<D>& cone) const {
    const Index first = walls_.first_cell(layer, columns_.swept_facet[cell][corner]);
    for (Index c = first; c < first + walls_.cells_per_wall(); ++c) {
        PrismPiece<D> piece;
        for (std::size_t i = 0; i <= D; ++i) {
            const Index v = walls_.hull().cells[c][i];
            auto local = std::find(vertex.begin(), vertex.end(), v);
            if (local == vertex.end()) {
                local = vertex.begin() + CellPrismPoint<D>::wall_centre(corner);
                *local = v;
            }
            piece[i] = static_cast<std::uint8_t>(local - vertex.begin());
        }
        cone.pieces.push_back(piece);
    }
}

/// Adds an inner wall (D = 3): the cone from its centre over its facets below and above and its
/// quadrilaterals.
template<int D>
void ConeCells<D>::add_coned_wall(std::size_t layer, Index cell, std::size_t corner,
                                  PrismCone<D>& cone) const {
    using Local = CellPrismPoint<D>;
    if constexpr (D == 3) {
        const std::uint8_t centre = Local::wall_centre(corner);
        std::array<std::size_t, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            at[k] = k < corner ? k : k + 1;
        }
        cone.pieces.push_back({centre, Local::below(at[0]), Local::below(at[1]), Local::below(at[2])});
        cone.pieces.push_back({centre, Local::above(at[0]), Local::above(at[1]), Local::above(at[2])});
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t j = 0; j < k; ++j) {
                add_quad(layer, cell, centre, at[j], at[k], cone);
            }
        }
    }
}

/// Adds the cone from a wall's centre over the quadrilateral above the edge between corners j < k.
template<int D>
void ConeCells<D>::add_quad(std::size_t layer, Index cell, std::uint8_t wall, std::size_t j, std::size_t k,
                            PrismCone<D>& cone) const {
    using Local = CellPrismPoint<D>;
    if constexpr (D == 3) {
        const Index number = walls_.quad(columns_.cells[cell][j], columns_.cells[cell][k]);
        const QuadSplit split = number == no_index ? QuadSplit{} : walls_.split(layer, number);
        const std::uint8_t j0 = Local::below(j);
        const std::uint8_t k0 = Local::below(k);
        const std::uint8_t j1 = Local::above(j);
        const std::uint8_t k1 = Local::above(k);
        if (split.centre != no_index) {
            const std::uint8_t centre = Local::quad_centre(j, k);
            cone.pieces.insert(cone.pieces.end(), {{wall, centre, j0, k0},
                                                   {wall, centre, j1, k1},
                                                   {wall, centre, j0, j1},
                                                   {wall, centre, k0, k1}});
        } else if (split.rising) {
            cone.pieces.insert(cone.pieces.end(), {{wall, j0, k0, k1}, {wall, j0, j1, k1}});
        } else {
            cone.pieces.insert(cone.pieces.end(), {{wall, j0, k0, j1}, {wall, k0, j1, k1}});
        }
    }
}

template class ConeCells<2>;
template class ConeCells<3>;

} // namespace slabhull
