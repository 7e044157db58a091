// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/fill.h"

#include "core/place_in_words.h"
#include "slab/adapt/replace_cells.h"
#include "slab/fill/describe_hull.h"
#include "slab/fill/layer_side.h"
#include "slab/fill/mend_cells.h"
#include "slab/fill/staircase.h"
#include "slab/fill/wall_pieces.h"
#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"
#include "topology/complex/sorted_cell.h"
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Numbers the filling's vertices on levels: the hull's, then the inner ones by inner level. Sets the column
/// of each of the hull's vertices that has one.
template<int D>
SlabColumns<D> columns_of_log(const Hull<D>& hull, const AdaptLog<D>& log, std::vector<Index>& hull_column,
                              Filling<D>& filling) {
    SlabColumns<D> columns;
    columns.times = log.times;
    columns.count = log.tracks.size();
    checked_index(hull.points.size() + columns.times.size() * columns.count, "vertices of the filling");
    columns.vertex.assign(columns.times.size() * columns.count, no_index);
    const auto column_of = [&](TrackId track) {
        return static_cast<std::size_t>(std::lower_bound(log.tracks.begin(), log.tracks.end(), track) -
                                        log.tracks.begin());
    };
    hull_column.assign(hull.points.size(), no_index);
    std::vector<TrackId> tracks(hull.points.size());
    hull.track_ids.copy(0, tracks.size(), tracks.data());
    for (std::size_t v = 0; v < tracks.size(); ++v) {
        if (tracks[v] == no_track) {
            continue;
        }
        const double t = hull.points[v][D];
        const auto level =
            v < hull.initial_points ? 0
            : v >= hull.terminating_points_begin()
                ? columns.layers()
                : static_cast<std::size_t>(std::lower_bound(log.times.begin(), log.times.end(), t) -
                                           log.times.begin());
        const std::size_t column = column_of(tracks[v]);
        columns.vertex[level * columns.count + column] = static_cast<Index>(v);
        hull_column[v] = static_cast<Index>(column);
    }
    filling.points = hull.points;
    for (std::size_t level = 1; level < columns.layers(); ++level) {
        for (std::size_t k = 0; k < log.columns[level].size(); ++k) {
            Index& vertex = columns.vertex[level * columns.count + log.columns[level][k]];
            if (vertex == no_index) {
                vertex = static_cast<Index>(filling.points.size());
                Point<D + 1> point;
                std::copy_n(log.places[level][k].begin(), D, point.begin());
                point[D] = log.times[level];
                filling.points.push_back(point);
            }
        }
    }
    return columns;
}

/// Makes the simplices of one slab, layer by layer.
template<int D>
class AdaptedFiller {
public:
    AdaptedFiller(const Hull<D>& hull, const AdaptLog<D>& log)
        : hull_{hull}, log_{log}, columns_{columns_of_log(hull, log, hull_column_, filling_)},
          levels_end_{filling_.points.size()}, cells_{log.cells} {}

    Filling<D> run(StageClock& clock) {
        WallPieces<D> pieces{columns_, filling_};
        auto first = static_cast<Index>(hull_.initial_cells);
        for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
            const Index end = layer_end(first, layer);
            const LayerSide<D> side{hull_, columns_, hull_column_, layer, {first, end}};
            pieces.enter(side);
            fill_layer(layer, side, pieces);
            first = end;
        }
        filling_.steiner_points = filling_.points.size() - levels_end_;
        describe();
        clock.book("filling");
        std::vector<Index> bad = not_positive(filling_);
        if (!bad.empty()) {
            bad = mend_cells(std::move(bad), hull_.initial_cells, columns_.layers(), filling_);
        }
        if (!bad.empty()) {
            refuse(bad);
        }
        clock.book("mending");
        Adjacency<D + 1> adjacency = build_adjacency<D + 1>(filling_.cells, filling_.points.size());
        filling_.neighbors = std::move(adjacency.neighbors);
        clock.book("adjacency");
        return std::move(filling_);
    }

private:
    /// The cell of the side behind those of a layer.
    Index layer_end(Index first, std::size_t layer) const {
        std::size_t end = first;
        while (end < hull_.terminating_begin() && hull_.layer(end) == static_cast<int>(layer)) {
            end = hull_.layer_end(end);
        }
        return static_cast<Index>(end);
    }

    void fill_layer(std::size_t layer, const LayerSide<D>& side, WallPieces<D>& pieces) {
        const std::size_t first = layer == 0 ? 0 : log_.layer_end[layer - 1];
        const std::size_t end = log_.layer_end[layer];
        std::vector<std::uint8_t> removed(cells_.size(), 0);
        for (std::size_t k = removed_end(first); k < removed_end(end); ++k) {
            removed[log_.removed[k]] = 1;
        }
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            if (removed[c] == 0) {
                extrude(layer, cells_[c], side, pieces);
            }
        }
        for (std::size_t k = first; k < end; ++k) {
            cone(layer, k, pieces);
        }
        const std::vector<Index> gone(log_.removed.begin() + static_cast<std::ptrdiff_t>(removed_end(first)),
                                      log_.removed.begin() + static_cast<std::ptrdiff_t>(removed_end(end)));
        const std::span<const Simplex<D>> added{log_.added.data() + added_end(first),
                                                added_end(end) - added_end(first)};
        CellReplacement{cells_.size(), gone, added.size()}.apply(cells_, added);
    }

    std::size_t removed_end(std::size_t operations) const {
        return operations == 0 ? 0 : log_.operations[operations - 1].removed_end;
    }
    std::size_t added_end(std::size_t operations) const {
        return operations == 0 ? 0 : log_.operations[operations - 1].added_end;
    }

    /// Fills the prism over a cell that stays.
    void extrude(std::size_t layer, const Simplex<D>& cell, const LayerSide<D>& side, WallPieces<D>& pieces) {
        if (!side.all_staircases() && pieces.meets_other_split(cell)) {
            Point<D + 1> centre{};
            for (const Index column : cell) {
                for (const std::size_t level : {layer, layer + 1}) {
                    const Point<D + 1>& corner = filling_.points[columns_.at(level, column)];
                    for (std::size_t k = 0; k <= D; ++k) {
                        centre[k] += corner[k] / (2.0 * (D + 1));
                    }
                }
            }
            cone_over(layer, {&cell, 1}, {&cell, 1}, centre, pieces);
            return;
        }
        const SortedCell<D> sorted = sort_cell<D>(cell);
        for (std::size_t m = 0; m <= D; ++m) {
            Simplex<D + 1> piece = staircase_piece<D>(columns_, layer, sorted.vertices, m);
            if (sorted.odd != ((D - m) % 2 == 1)) {
                std::swap(piece[0], piece[1]);
            }
            filling_.cells.push_back(piece);
        }
    }

    /// Cones the cell between an operation's cells.
    void cone(std::size_t layer, std::size_t number, WallPieces<D>& pieces) {
        std::vector<Simplex<D>> below;
        for (std::size_t k = removed_end(number); k < removed_end(number + 1); ++k) {
            below.push_back(cells_[log_.removed[k]]);
        }
        const std::span<const Simplex<D>> above{log_.added.data() + added_end(number),
                                                added_end(number + 1) - added_end(number)};
        cone_over(layer, below, above, log_.operations[number].apex, pieces);
    }

    void cone_over(std::size_t layer, std::span<const Simplex<D>> below, std::span<const Simplex<D>> above,
                   const Point<D + 1>& place, WallPieces<D>& pieces) {
        outside_.clear();
        pieces.append(layer, outer_facets(below), outside_); // may add points
        const auto apex = static_cast<Index>(filling_.points.size());
        filling_.points.push_back(place);
        const auto add_level = [&](std::span<const Simplex<D>> cells, std::size_t level, bool odd) {
            for (const Simplex<D>& cell : cells) {
                Simplex<D> corners;
                for (std::size_t k = 0; k <= D; ++k) {
                    corners[k] = columns_.at(level, cell[k]);
                }
                add_cone(corners, apex, odd);
            }
        };
        add_level(below, layer, false);
        add_level(above, layer + 1, true);
        for (const Simplex<D>& piece : outside_) {
            add_cone(piece, apex, true);
        }
    }

    /// `odd`: whether (corners, apex) is negative.
    void add_cone(const Simplex<D>& corners, Index apex, bool odd) {
        Simplex<D + 1> piece;
        std::copy(corners.begin(), corners.end(), piece.begin());
        piece[D + 1] = apex;
        if (odd) {
            std::swap(piece[0], piece[1]);
        }
        filling_.cells.push_back(piece);
    }

    /// The facets of some cells that only one of them has, outward.
    static std::vector<Facet<D>> outer_facets(std::span<const Simplex<D>> cells) {
        std::vector<std::pair<Facet<D>, Facet<D>>> facets; // ascending, outward
        for (const Simplex<D>& cell : cells) {
            for (int i = 0; i <= D; ++i) {
                const Facet<D> outward = outward_facet<D>(cell, i);
                Facet<D> sorted = outward;
                std::sort(sorted.begin(), sorted.end());
                facets.emplace_back(sorted, outward);
            }
        }
        std::sort(facets.begin(), facets.end());
        std::vector<Facet<D>> outer;
        for (std::size_t k = 0; k < facets.size();) {
            const bool twice = k + 1 < facets.size() && facets[k + 1].first == facets[k].first;
            if (!twice) {
                outer.push_back(facets[k].second);
            }
            k += twice ? 2 : 1;
        }
        return outer;
    }

    void describe() {
        describe_hull(hull_, filling_);
        for (std::size_t level = 1; level < columns_.layers(); ++level) {
            for (const Index column : log_.columns[level]) {
                if (columns_.at(level, column) >= hull_.points.size()) {
                    filling_.track_ids.push_back(log_.tracks[column]);
                }
            }
        }
        filling_.track_ids.append_run(no_track, filling_.steiner_points, 0);
    }

    [[noreturn]] void refuse(const std::vector<Index>& bad) const {
        constexpr std::size_t most_named = 10;
        std::vector<Entity> entities;
        std::string places;
        for (std::size_t k = 0; k < std::min(bad.size(), most_named); ++k) {
            const Point<D + 1>& place = filling_.points[filling_.cells[bad[k]][0]];
            entities.push_back({"cell", bad[k], {}});
            places += fmt::format("{} {}", k == 0 ? "" : ",", place_in_words(place));
        }
        throw GeometryError{
            fmt::format("{} of {} simplices of the filling would be inside out or flat, near{}; more layers "
                        "(time.layers) or shorter slabs (time.slabs) do, since each then turns less",
                        bad.size(), filling_.cells.size(), places),
            std::move(entities)};
    }

    const Hull<D>& hull_;
    const AdaptLog<D>& log_;
    Filling<D> filling_;
    std::vector<Index> hull_column_; ///< of each of the hull's vertices
    SlabColumns<D> columns_;
    std::size_t levels_end_;
    Array<Simplex<D>> cells_;         ///< at the start of the present layer, as columns
    std::vector<Simplex<D>> outside_; ///< of a cone: the pieces of its walls, outward
};

} // namespace

template<int D>
Filling<D> fill_adapted(const Hull<D>& hull, const AdaptLog<D>& log, StageClock& clock) {
    return AdaptedFiller<D>{hull, log}.run(clock);
}

template<int D>
Filling<D> fill_slab(const Slab<D>& slab, StageClock& clock) {
    return slab.adapted ? fill_adapted(slab.hull, slab.adapted->log, clock) : fill_slab(slab.hull, clock);
}

template<int D>
Filling<D> fill_slab(const Slab<D>& slab) {
    StageClock clock;
    return fill_slab(slab, clock);
}

template Filling<2> fill_slab<2>(const Slab<2>&, StageClock&);
template Filling<3> fill_slab<3>(const Slab<3>&, StageClock&);
template Filling<2> fill_slab<2>(const Slab<2>&);
template Filling<3> fill_slab<3>(const Slab<3>&);
template Filling<2> fill_adapted<2>(const Hull<2>&, const AdaptLog<2>&, StageClock&);
template Filling<3> fill_adapted<3>(const Hull<3>&, const AdaptLog<3>&, StageClock&);

} // namespace slabhull
