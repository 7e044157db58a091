// SPDX-License-Identifier: BSD-3-Clause
#include "slab/stitch/layered_side.h"

#include "slab/stitch/prism_choice.h"
#include "slab/stitch/prism_graph.h"
#include "slab/stitch/side_points.h"
#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace slabhull {

template<int D>
LayeredSide<D>::LayeredSide(std::size_t initial_points, const LayeredSweep<D>& sweep,
                            const SideOptions& options)
    : initial_points_{initial_points}, sweep_{sweep} {
    enter_level(0);
    for (std::size_t layer = 0; layer < sweep.layers.size(); ++layer) {
        add_layer(layer, options);
    }
    for (Simplex<D>& cell : cells_) {
        for (Index& v : cell) {
            v = v > no_index / 2 ? static_cast<Index>(initial_points_ + points_.size() + (on_terminating - v))
                                 : v;
        }
    }
}

/// Numbers the vertices of a level's boundary by column.
template<int D>
void LayeredSide<D>::enter_level(std::size_t level) {
    const bool last = level == sweep_.layers.size();
    const std::vector<Index>& columns = last ? sweep_.last_columns : sweep_.layers[level].columns;
    std::vector<Index>& vertex = vertex_of_column_.emplace_back();
    for (Index v = 0; v < columns.size(); ++v) {
        const std::size_t column = columns[v];
        vertex.resize(std::max(vertex.size(), column + 1), no_index);
        if (level == 0) {
            vertex[column] = sweep_.layers.front().boundary.mesh_vertices()[v];
        } else if (last) {
            vertex[column] = on_terminating - v;
        } else {
            vertex[column] = checked_index(initial_points_ + points_.size(), "hull vertices");
            points_.push_back(at_time<D>(sweep_.places[level][v], sweep_.times[level]));
            column_.push_back(static_cast<std::int64_t>(column));
        }
    }
}

template<int D>
Index LayeredSide<D>::level_vertex(std::size_t level, Index column) const {
    return vertex_of_column_[level][column];
}

/// One layer with the local numbers of SideVertices: the boundary below, centres, the boundary above.
template<int D>
struct LayeredSide<D>::LayerBuilder {
    const SideLayer<D>& layer;
    const SplitRecipe& recipe;
    Sweep<D> sweep;
    PrismGraph<D> graph;
    SideVertices<D> vertices;
    std::vector<Point<D + 1>> points;
    PrismChoice choice;

    LayerBuilder(const SideLayer<D>& of, const Array<Point<D>>& start, double begin, double end,
                 const SideOptions& options)
        : layer{of}, recipe{recipe_of(options.split)}, sweep{of.boundary.bounding({}),
                                                             {begin, end},
                                                             {start, of.end},
                                                             {}},
          graph{connect_prisms<D>(sweep.boundary, recipe)}, vertices{start.size(), sweep, graph, recipe},
          points(vertices.end() + start.size()) {
        for (Index v = 0; v < start.size(); ++v) {
            points[v] = at_time<D>(start[v], begin);
            points[vertices.end() + v] = at_time<D>(of.end[v], end);
        }
        const SidePoints<D> side{sweep, graph, vertices};
        for (std::size_t v = vertices.begin(); v < vertices.end(); ++v) {
            points[v] = side.of_vertex(v);
        }
        choice = choose_templates<D>(options, graph, sweep, side, {0, 1});
    }

    /// The pieces of the wall over ridge i of a facet, in local numbers.
    std::vector<std::array<Index, D>> wall(std::span<const PrismTemplate<D>> templates, std::size_t f,
                                           std::size_t i) const {
        using Template = PrismTemplate<D>;
        const Template& filling = templates[choice(0, f)];
        const auto prism = vertices.of_prism(0, f);
        std::vector<std::array<Index, D>> pieces;
        for (std::size_t p = 0; p < Template::pieces; ++p) {
            const std::uint8_t slot = Template::lateral(i, p);
            const std::uint8_t c = filling.cell_at[slot];
            if (c == Template::no_cell) {
                continue;
            }
            std::array<Index, D> piece{};
            std::size_t n = 0;
            std::size_t opposite = 0; // corner of the cell
            for (std::size_t k = 0; k <= D; ++k) {
                if (filling.across[c][k] != Template::outside + slot) {
                    piece[n++] = prism[filling.cells[c][k]];
                } else {
                    opposite = k;
                }
            }
            if ((opposite + D) % 2 == 1) { // so that, followed by an apex, it is outward
                std::swap(piece[0], piece[1]);
            }
            pieces.push_back(piece);
        }
        return pieces;
    }
};

template<int D>
void LayeredSide<D>::add_layer(std::size_t number, const SideOptions& options) {
    const SideLayer<D>& layer = sweep_.layers[number];
    const LayerBuilder builder{layer, sweep_.places[number], sweep_.times[number], sweep_.times[number + 1],
                               options};
    const auto templates = templates_of<D>(options.split);
    const Boundary<D>& boundary = layer.boundary;
    std::vector<Index> change_of(boundary.facet_count(), no_index);
    for (std::size_t k = 0; k < layer.changes.size(); ++k) {
        for (const Index f : layer.changes[k].removed) {
            change_of[f] = static_cast<Index>(k);
        }
    }
    std::vector<std::vector<std::array<Index, D>>> walls(layer.changes.size());
    std::vector<std::uint8_t> used(builder.points.size(), 0);
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        if (change_of[f] == no_index) {
            const auto prism = builder.vertices.of_prism(0, f);
            for (const auto& cell : templates[builder.choice(0, f)].cells) {
                for (const std::uint8_t v : cell) {
                    used[prism[v]] = 1;
                }
            }
            continue;
        }
        for (std::size_t i = 0; i < D; ++i) {
            if (change_of[boundary.neighbors()[f][i]] != change_of[f]) {
                for (const auto& piece : builder.wall(templates, f, i)) {
                    walls[change_of[f]].push_back(piece);
                    for (const Index v : piece) {
                        used[v] = 1;
                    }
                }
            }
        }
    }
    // Centres in use get their numbers now, before the next level's vertices.
    std::vector<Index> vertex(builder.points.size(), no_index);
    const std::size_t below = boundary.vertex_count();
    for (std::size_t v = below; v < builder.vertices.end(); ++v) {
        if (used[v] != 0) {
            vertex[v] = checked_index(initial_points_ + points_.size(), "hull vertices");
            points_.push_back(builder.points[v]);
            column_.push_back(-1);
        }
    }
    std::vector<Index> apexes;
    for (const BoundaryChange<D>& change : layer.changes) {
        apexes.push_back(checked_index(initial_points_ + points_.size(), "hull vertices"));
        points_.push_back(change.apex);
        column_.push_back(-1);
    }
    enter_level(number + 1);
    for (Index v = 0; v < below; ++v) {
        const Index column = layer.columns[v];
        const std::vector<Index>& above = vertex_of_column_[number + 1];
        vertex[v] = level_vertex(number, column);
        vertex[builder.vertices.end() + v] = column < above.size() ? above[column] : no_index;
    }
    const auto part = [&](PatchNumber patch) {
        parts_.push_back({static_cast<Index>(cells_.size()), patch, static_cast<std::int32_t>(number)});
    };
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        if (change_of[f] != no_index) {
            continue;
        }
        part(boundary.patch()[f]);
        const auto prism = builder.vertices.of_prism(0, f);
        for (const auto& local : templates[builder.choice(0, f)].cells) {
            Simplex<D> cell;
            for (std::size_t i = 0; i <= D; ++i) {
                cell[i] = vertex[prism[local[i]]];
            }
            cells_.push_back(cell);
        }
    }
    for (std::size_t k = 0; k < layer.changes.size(); ++k) {
        const BoundaryChange<D>& change = layer.changes[k];
        part(change.patch);
        std::vector<std::array<Index, D>> pieces;
        for (const Index f : change.removed) {
            std::array<Index, D> piece;
            for (std::size_t i = 0; i < D; ++i) {
                piece[i] = vertex[boundary.facets()[f][i]];
            }
            std::swap(piece[0], piece[1]); // a facet before a later vertex is inward
            pieces.push_back(piece);
        }
        for (const Facet<D>& facet : change.added) {
            std::array<Index, D> piece;
            for (std::size_t i = 0; i < D; ++i) {
                piece[i] = level_vertex(number + 1, facet[i]);
            }
            pieces.push_back(piece);
        }
        for (std::array<Index, D> piece : walls[k]) {
            for (Index& v : piece) {
                v = vertex[v];
            }
            pieces.push_back(piece);
        }
        add_cone(pieces, apexes[k]);
    }
}

/// Cones pieces that are outward when the apex follows them.
template<int D>
void LayeredSide<D>::add_cone(std::span<const std::array<Index, D>> pieces, Index apex) {
    for (const auto& piece : pieces) {
        Simplex<D> cell;
        std::copy(piece.begin(), piece.end(), cell.begin());
        cell[D] = apex;
        cells_.push_back(cell);
    }
}

template<int D>
Hull<D> LayeredSide<D>::stitch(CapToStitch<D> initial, CapToStitch<D> terminating,
                               std::span<const TrackId> tracks, IdCounter& ids) && {
    Hull<D> hull;
    const SpatialMesh<D>& first = initial.mesh();
    const SpatialMesh<D>& last = terminating.mesh();
    hull.initial_points = first.points.size();
    hull.side_points = points_.size();
    hull.initial_cells = first.cells.size();
    hull.side_cells = cells_.size();
    hull.layers = sweep_.layers.size();
    hull.cells_per_prism = 0;
    hull.facet_patch.assign(sweep_.last.patch().begin(), sweep_.last.patch().end());
    hull.patches = sweep_.last.patches();
    hull.time = {sweep_.times.front(), sweep_.times.back()};
    checked_index(hull.terminating_points_begin() + last.points.size(), "hull vertices");
    checked_index(hull.terminating_begin() + last.cells.size(), "hull cells");
    for (const Point<D>& place : first.points) {
        hull.points.push_back(at_time<D>(place, hull.time[0]));
    }
    hull.points.insert(hull.points.end(), points_.begin(), points_.end());
    for (const Point<D>& place : last.points) {
        hull.points.push_back(at_time<D>(place, hull.time[1]));
    }
    for (Simplex<D> cell : first.cells) {
        std::swap(cell[0], cell[1]); // the cap faces back in time
        hull.cells.push_back(cell);
    }
    hull.cells.insert(hull.cells.end(), cells_.begin(), cells_.end());
    for (Simplex<D> cell : last.cells) {
        for (Index& v : cell) {
            v += static_cast<Index>(hull.terminating_points_begin());
        }
        hull.cells.push_back(cell);
    }
    Adjacency<D> adjacency = build_adjacency<D>(hull.cells, hull.points.size());
    if (!adjacency.defects.empty()) {
        throw GeometryError{
            fmt::format("the caps and the side of the slab from t = {} to {} do not close at {} "
                        "facets, the first of cell {}",
                        hull.time[0], hull.time[1], adjacency.defects.size(),
                        adjacency.defects.front().cells.front()),
            {{"cell", adjacency.defects.front().cells.front(), {}}}};
    }
    hull.neighbors = std::move(adjacency.neighbors);
    hull.vertex_ids.append(first.vertex_ids);
    hull.vertex_ids.append_run(ids.take(points_.size()), points_.size(), 1);
    hull.vertex_ids.append(last.vertex_ids);
    hull.track_ids.append(initial.tracks());
    for (const std::int64_t column : column_) {
        hull.track_ids.push_back(column < 0 ? no_track : tracks[static_cast<std::size_t>(column)]);
    }
    hull.track_ids.append(last.track_ids);
    hull.side_parts = std::move(parts_);
    for (SidePart& part : hull.side_parts) {
        part.first += static_cast<Index>(hull.initial_cells);
    }
    return hull;
}

template class LayeredSide<2>;
template class LayeredSide<3>;

} // namespace slabhull
