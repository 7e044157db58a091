// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/mend_cells.h"

#include "geometry/basics/largest_minimum.h"
#include "slab/check/findings.h"
#include "slab/fill/layer_scale.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/simplex_sign.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace slabhull {

namespace {

/// Mends one filling.
template<int D>
class CellMender {
public:
    CellMender(std::size_t initial_cells, std::size_t layers, Filling<D>& filling)
        : filling_{filling}, levels_end_{static_cast<Index>(filling.points.size() - filling.steiner_points)},
          time_scale_{layer_scale<D>(std::span{filling.facets}.first(initial_cells), filling.points, layers,
                                     filling.time)} {}

    /// Returns the simplices that are left.
    std::vector<Index> run(std::vector<Index> bad) {
        constexpr int most_rounds = 30;
        constexpr int widest = 3;
        int rings = 0; // of neighbours that are also moved
        for (int round = 0; round < most_rounds && !bad.empty(); ++round) {
            gather(bad, rings);
            bool moved = false;
            for (std::size_t k = 0; k < movable_.size(); ++k) {
                moved = move(movable_[k], stars_[k]) || moved;
            }
            const std::size_t before = bad.size();
            bad = not_positive(filling_);
            if (!moved || bad.size() >= before) {
                if (rings == widest) {
                    break;
                }
                ++rings;
            }
        }
        return bad;
    }

private:
    static constexpr std::size_t N = D + 1;

    bool is_movable(Index v) const { return v >= filling_.hull_points; }

    /// Collects the movable vertices of simplices and of some rings around them, with their stars.
    void gather(const std::vector<Index>& bad, int rings) {
        std::vector<std::uint8_t> reached(filling_.points.size(), 0);
        for (const Index c : bad) {
            reach(filling_.cells[c], reached);
        }
        for (int ring = 0; ring < rings; ++ring) {
            for (const Index c : cells_at(reached)) {
                reach(filling_.cells[c], reached);
            }
        }
        movable_ = select(reached.size(), [&](std::size_t v) { return reached[v] != 0; });
        stars_.assign(movable_.size(), {});
        for (const Index c : cells_at(reached)) {
            for (const Index v : filling_.cells[c]) {
                if (reached[v] != 0) {
                    const auto place = std::lower_bound(movable_.begin(), movable_.end(), v);
                    stars_[static_cast<std::size_t>(place - movable_.begin())].push_back(c);
                }
            }
        }
    }

    std::vector<Index> cells_at(const std::vector<std::uint8_t>& vertices) const {
        return select(filling_.cells.size(), [&](std::size_t c) {
            return std::any_of(filling_.cells[c].begin(), filling_.cells[c].end(),
                               [&](Index v) { return vertices[v] != 0; });
        });
    }

    void reach(const Simplex<N>& cell, std::vector<std::uint8_t>& reached) const {
        for (const Index v : cell) {
            reached[v] = is_movable(v) ? 1 : reached[v];
        }
    }

    bool move(Index v, const std::vector<Index>& star) {
        return v < levels_end_ ? move_within<D>(v, star) : move_within<D + 1>(v, star);
    }

    /// Moves a vertex in its first Free coordinates.
    template<int Free>
    bool move_within(Index v, const std::vector<Index>& star) {
        const double unit = size_of(star);
        if (!(unit > 0)) {
            return false;
        }
        std::vector<AffineFunction<Free>> distances;
        for (const Index c : star) {
            distances.push_back(distance_to_facet<Free>(v, filling_.cells[c], unit));
        }
        const std::optional<Point<Free>> best = better_place<Free>(distances);
        if (!best) {
            return false;
        }
        for (std::size_t k = 0; k < Free; ++k) {
            filling_.points[v][k] += (*best)[k] * unit / (k == D ? time_scale_ : 1);
        }
        return true;
    }

    /// A place where all distances are positive and the least has grown. If there is none, one where negative
    /// distances have grown and no other has become negative.
    template<int Free>
    static std::optional<Point<Free>> better_place(const std::vector<AffineFunction<Free>>& distances) {
        constexpr double worthwhile = 1e-6;
        using View = std::span<const AffineFunction<Free>>;
        const double now = least<Free>(distances, {});
        const Point<Free> best = largest_minimum<Free>(View{distances});
        if (const double then = least<Free>(distances, best); then > 0 || now > 0) {
            return then > now + worthwhile ? std::optional{best} : std::nullopt;
        }
        constexpr double kept = 0.2; // share of positive distances
        constexpr double weight = 1e4;
        std::vector<AffineFunction<Free>> guarded = distances;
        for (AffineFunction<Free>& function : guarded) {
            if (function.value > 0) {
                function.value *= (1 - kept) * weight;
                for (double& slope : function.gradient) {
                    slope *= weight;
                }
            }
        }
        const Point<Free> next = largest_minimum<Free>(View{guarded});
        const bool sound = std::all_of(distances.begin(), distances.end(), [&](const auto& function) {
            return function.value <= 0 || function.at(next) > 0;
        });
        return sound && least<Free>(distances, next) > now + worthwhile ? std::optional{next} : std::nullopt;
    }

    template<int Free>
    static double least(const std::vector<AffineFunction<Free>>& functions, const Point<Free>& x) {
        double value = std::numeric_limits<double>::infinity();
        for (const AffineFunction<Free>& function : functions) {
            value = std::min(value, function.at(x));
        }
        return value;
    }

    Point<N> scaled(Index v) const {
        Point<N> place = filling_.points[v];
        place[D] *= time_scale_;
        return place;
    }

    /// Half the longest edge.
    double size_of(const std::vector<Index>& star) const {
        double longest = 0;
        for (const Index c : star) {
            for (std::size_t i = 1; i <= N; ++i) {
                longest =
                    std::max(longest, distance(scaled(filling_.cells[c][0]), scaled(filling_.cells[c][i])));
            }
        }
        return longest / 2;
    }

    /// Signed distance of a vertex, displaced by x units, from the facet opposite to it; positive inside.
    template<int Free>
    AffineFunction<Free> distance_to_facet(Index v, const Simplex<N>& cell, double unit) const {
        const auto place = std::find(cell.begin(), cell.end(), v) - cell.begin();
        const Simplex<D> facet = outward_facet<N>(cell, static_cast<int>(place));
        std::array<Point<N>, N> corners;
        for (std::size_t i = 0; i < N; ++i) {
            corners[i] = minus(scaled(facet[i]), scaled(v));
            for (double& coordinate : corners[i]) {
                coordinate /= unit;
            }
        }
        const Point<N> normal = simplex_normal<D>(corners);
        const double length = norm(normal);
        AffineFunction<Free> function{{}, 0};
        if (length > 0) {
            function.value = dot(normal, corners[0]) / length;
            for (std::size_t k = 0; k < Free; ++k) {
                function.gradient[k] = -normal[k] / length;
            }
        }
        return function;
    }

    Filling<D>& filling_;
    Index levels_end_; ///< end of the vertices on levels; centres follow
    double time_scale_;
    std::vector<Index> movable_;
    std::vector<std::vector<Index>> stars_;
};

} // namespace

template<int D>
std::vector<Index> not_positive(const Filling<D>& filling) {
    return select(filling.cells.size(), [&](std::size_t c) {
        return simplex_sign<D + 1>(corners_of<D + 1, D + 1>(filling.cells[c], filling.points)) <= 0;
    });
}

template<int D>
std::vector<Index> mend_cells(std::vector<Index> bad, std::size_t initial_cells, std::size_t layers,
                              Filling<D>& filling) {
    return CellMender<D>{initial_cells, layers, filling}.run(std::move(bad));
}

template<int D>
void refuse_cells(const std::vector<Index>& bad, const Filling<D>& filling, const SlabColumns<D>& columns,
                  const ConeCells<D>& cones) {
    constexpr std::size_t most_named = 10;
    std::vector<Entity> entities;
    std::string places;
    Index last_cell = no_index;
    std::size_t last_layer = 0;
    std::size_t on_hull = 0;
    for (const Index simplex : bad) {
        const Simplex<D + 1>& corners = filling.cells[simplex];
        on_hull +=
            std::all_of(corners.begin(), corners.end(), [&](Index v) { return v < filling.hull_points; });
        const std::size_t layer = simplex / cones.cells_per_layer();
        const Index cell = cones.cell_of(simplex % cones.cells_per_layer());
        if ((cell == last_cell && layer == last_layer) || entities.size() == 2 * most_named) {
            continue;
        }
        entities.push_back({"cell", cell, {}});
        entities.push_back({"layer", static_cast<std::int64_t>(layer), {}});
        places += fmt::format("{} cell {} in layer {} (t = {} to {})", places.empty() ? "" : ",", cell, layer,
                              columns.times[layer], columns.times[layer + 1]);
        last_cell = cell;
        last_layer = layer;
    }
    throw GeometryError{
        fmt::format(
            "{} of {} simplices of the filling would be inside out or flat, over the initial cap's{}; "
            "{} of them have all their vertices on the hull, and no places of those inside help the "
            "others; more layers (time.layers) or shorter slabs (time.slabs) do, since each then turns "
            "less",
            bad.size(), filling.cells.size(), places, on_hull),
        std::move(entities)};
}

template std::vector<Index> not_positive<2>(const Filling<2>&);
template std::vector<Index> mend_cells<2>(std::vector<Index>, std::size_t, std::size_t, Filling<2>&);
template void refuse_cells<2>(const std::vector<Index>&, const Filling<2>&, const SlabColumns<2>&,
                              const ConeCells<2>&);
template std::vector<Index> not_positive<3>(const Filling<3>&);
template std::vector<Index> mend_cells<3>(std::vector<Index>, std::size_t, std::size_t, Filling<3>&);
template void refuse_cells<3>(const std::vector<Index>&, const Filling<3>&, const SlabColumns<3>&,
                              const ConeCells<3>&);

} // namespace slabhull
