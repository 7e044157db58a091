// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/check.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

/// Hulls made by hand: a grid of cut cubes, swept in time, its prisms cut along diagonals of smallest vertex.
namespace slabhull::specimens {

template<int D>
struct Grid {
    Array<Point<D>> points;
    Array<Simplex<D>> cells; ///< positive
};

/// The cubes of an n^D grid for which `inside(cube)` holds, each cut into D! simplices.
template<int D>
Grid<D> grid(Index n, const std::function<bool(const std::array<Index, D>&)>& inside) {
    Grid<D> result;
    std::map<std::array<Index, D>, Index> number;
    const auto vertex = [&](const std::array<Index, D>& at) {
        const auto [place, is_new] = number.try_emplace(at, static_cast<Index>(result.points.size()));
        if (is_new) {
            Point<D> point;
            std::copy(at.begin(), at.end(), point.begin());
            result.points.push_back(point);
        }
        return place->second;
    };
    Index cubes = 1;
    for (int k = 0; k < D; ++k) {
        cubes *= n;
    }
    for (Index cube = 0; cube < cubes; ++cube) {
        std::array<Index, D> corner{};
        for (Index k = 0, rest = cube; k < D; ++k, rest /= n) {
            corner[k] = rest % n;
        }
        std::array<Index, D> order{};
        std::iota(order.begin(), order.end(), Index{0});
        do {
            if (!inside(corner)) {
                break;
            }
            std::array<Index, D> at = corner;
            Simplex<D> cell{vertex(at)};
            for (std::size_t k = 0; k < D; ++k) {
                ++at[order[k]];
                cell[k + 1] = vertex(at);
            }
            if (signed_measure<D>(corners_of<D, D>(cell, result.points)) < 0) {
                std::swap(cell[D - 1], cell[D]);
            }
            result.cells.push_back(cell);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    return result;
}

/// A cube of 5^D cubes without the middle one: a body in a box.
template<int D>
Grid<D> box_with_body() {
    return grid<D>(5, [](const std::array<Index, D>& at) {
        return std::any_of(at.begin(), at.end(), [](Index k) { return k != 2; });
    });
}

template<int D>
Grid<D> box_with_two_bodies() {
    return grid<D>(5, [](const std::array<Index, D>& at) {
        const bool middle = std::all_of(at.begin() + 1, at.end(), [](Index k) { return k == 2; });
        return !(middle && (at[0] == 1 || at[0] == 3));
    });
}

template<int D>
Grid<D> full_box(Index n) {
    return grid<D>(n, [](const std::array<Index, D>&) { return true; });
}

/// Sweeps a grid over `layers` layers in [1, 2]. Boundary vertices off the box drift; patch 1 is the box, 2
/// the bodies.
template<int D>
class HullMaker {
public:
    HullMaker(const Grid<D>& grid, std::size_t layers) : grid_{grid}, layers_{layers} {
        find_boundary();
        for (std::size_t level = 0; level <= layers; ++level) {
            add_level(level);
        }
        add_cells();
        finish();
    }
    Hull<D> hull;

private:
    void find_boundary() {
        const auto adjacency = build_adjacency<D>(grid_.cells, grid_.points.size());
        const double far = *std::max_element(grid_.points.back().begin(), grid_.points.back().end());
        on_boundary_.assign(grid_.points.size(), false);
        for (std::size_t c = 0; c < grid_.cells.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (adjacency.neighbors[c][i] == no_index) {
                    facets_.push_back(outward_facet<D>(grid_.cells[c], static_cast<int>(i)));
                    inner_.push_back(grid_.cells[c][i]);
                    hull.facet_patch.push_back(on_box(facets_.back(), far) ? 1 : 2);
                }
            }
        }
        for (const Facet<D>& facet : facets_) {
            for (const Index v : facet) {
                on_boundary_[v] = true;
            }
        }
        moving_.assign(grid_.points.size(), false);
        for (std::size_t f = 0; f < facets_.size(); ++f) {
            for (const Index v : facets_[f]) {
                moving_[v] = hull.facet_patch[f] == 2;
            }
        }
    }

    bool on_box(const Facet<D>& facet, double far) const {
        for (std::size_t x = 0; x < D; ++x) {
            for (const double side : {0.0, far}) {
                if (std::all_of(facet.begin(), facet.end(),
                                [&](Index v) { return grid_.points[v][x] == side; })) {
                    return true;
                }
            }
        }
        return false;
    }

    /// Interior vertices belong to the caps only.
    void add_level(std::size_t level) {
        const double s = static_cast<double>(level) / static_cast<double>(layers_);
        auto& number = number_.emplace_back(grid_.points.size(), no_index);
        for (std::size_t v = 0; v < grid_.points.size(); ++v) {
            if (!on_boundary_[v] && level != 0 && level != layers_) {
                continue;
            }
            number[v] = static_cast<Index>(hull.points.size());
            Point<D + 1> point{};
            for (std::size_t x = 0; x < D; ++x) {
                point[x] = grid_.points[v][x] + (moving_[v] ? 0.2 * s * s : 0.0);
            }
            point[D] = 1 + s;
            hull.points.push_back(point);
            hull.vertex_ids.push_back(static_cast<PersistentId>(1000 + 3 * hull.points.size()));
            hull.track_ids.push_back(on_boundary_[v] ? static_cast<TrackId>(7 + 2 * v) : no_track);
        }
    }

    void add_cells() {
        for (Simplex<D> cell : grid_.cells) {
            add_cell(cell, 0);
            std::swap(hull.cells.back()[0], hull.cells.back()[1]); // out of the slab is back in time
        }
        hull.initial_cells = hull.cells.size();
        for (std::size_t layer = 0; layer < layers_; ++layer) {
            for (std::size_t f = 0; f < facets_.size(); ++f) {
                add_prism(f, layer);
            }
        }
        hull.side_cells = hull.cells.size() - hull.initial_cells;
        for (const Simplex<D>& cell : grid_.cells) {
            add_cell(cell, layers_);
        }
    }

    void add_cell(const Simplex<D>& cell, std::size_t level) {
        Simplex<D> raised{};
        std::transform(cell.begin(), cell.end(), raised.begin(), [&](Index v) { return number_[level][v]; });
        hull.cells.push_back(raised);
    }

    void add_prism(std::size_t f, std::size_t layer) {
        Facet<D> facet = facets_[f];
        std::sort(facet.begin(), facet.end());
        for (std::size_t k = 0; k < D; ++k) { // bottom vertices up to k, top vertices from k
            Simplex<D> cell{};
            for (std::size_t i = 0; i <= D; ++i) {
                cell[i] = number_[i <= k ? layer : layer + 1][facet[i <= k ? i : i - 1]];
            }
            if (!faces_out(cell, f)) {
                std::swap(cell[0], cell[1]);
            }
            hull.cells.push_back(cell);
        }
    }

    /// The motion is slow enough for the normal to lean to the same side as in space.
    bool faces_out(const Simplex<D>& cell, std::size_t f) const {
        const Point<D + 1> normal = simplex_normal<D>(corners_of<D, D + 1>(cell, hull.points));
        double along = 0;
        for (std::size_t x = 0; x < D; ++x) {
            along += normal[x] * (grid_.points[facets_[f][0]][x] - grid_.points[inner_[f]][x]);
        }
        return along > 0;
    }

    void finish() {
        hull.neighbors = build_adjacency<D>(hull.cells, hull.points.size()).neighbors;
        hull.layers = layers_;
        hull.cells_per_prism = D;
        hull.patches = {{1, "box"}, {2, "body"}};
        hull.time = {1, 2};
    }

    const Grid<D>& grid_;
    std::size_t layers_;
    std::vector<Facet<D>> facets_;
    std::vector<Index> inner_; ///< the vertex of its cell that each facet leaves out
    std::vector<bool> on_boundary_;
    std::vector<bool> moving_;
    std::vector<std::vector<Index>> number_; ///< by level, then vertex of the grid
};

template<int D>
Hull<D> swept(const Grid<D>& grid, std::size_t layers) {
    return HullMaker<D>{grid, layers}.hull;
}

/// A hull as a file tells it, to be tampered with.
template<int D>
struct Claims {
    Array<Point<D + 1>> points;
    Array<Simplex<D>> cells;
    std::vector<std::int64_t> region, patch, layer, neighbors, vertex_id, track_id, cell_of_vertex;
    PatchList patches;
    std::optional<std::array<double, 2>> time;

    explicit Claims(const Hull<D>& hull)
        : points{hull.points}, cells{hull.cells}, vertex_id(hull.vertex_ids.begin(), hull.vertex_ids.end()),
          track_id(hull.track_ids.begin(), hull.track_ids.end()),
          cell_of_vertex(points.size()), patches{hull.patches}, time{hull.time} {
        for (std::size_t c = 0; c < cells.size(); ++c) {
            region.push_back(static_cast<std::int64_t>(hull.region(c)));
            patch.push_back(hull.patch(c));
            layer.push_back(hull.layer(c));
            neighbors.insert(neighbors.end(), hull.neighbors[c].begin(), hull.neighbors[c].end());
            for (const Index v : cells[c]) {
                cell_of_vertex[v] = static_cast<std::int64_t>(c);
            }
        }
    }

    /// After a change of cells, so that no claim is out of date.
    void renew_neighbors() {
        neighbors.clear();
        for (const Neighbors<D>& row : build_adjacency<D>(cells, points.size()).neighbors) {
            for (const Index neighbor : row) {
                neighbors.push_back(neighbor == no_index ? -1 : std::int64_t{neighbor});
            }
        }
        for (std::size_t c = 0; c < cells.size(); ++c) {
            for (const Index v : cells[c]) {
                cell_of_vertex[v] = static_cast<std::int64_t>(c);
            }
        }
    }

    HullColumns<D> columns() const {
        const auto over = [](const std::vector<std::int64_t>& values, int components = 1) {
            return Column<std::int64_t>::over(std::span{values}, components);
        };
        return {points,
                cells,
                over(region),
                over(patch),
                over(layer),
                over(neighbors, D + 1),
                over(vertex_id),
                over(track_id),
                over(cell_of_vertex),
                patches,
                time};
    }

    /// Points and cells only.
    HullColumns<D> bare() const {
        HullColumns<D> columns;
        columns.points = points;
        columns.cells = cells;
        return columns;
    }

    Index first_cell(Region wanted) const {
        const auto code = static_cast<std::int64_t>(wanted);
        return static_cast<Index>(std::find(region.begin(), region.end(), code) - region.begin());
    }
};

} // namespace slabhull::specimens
