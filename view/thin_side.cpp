// SPDX-License-Identifier: BSD-3-Clause
#include "view/thin_side.h"

#include "slabhull/slab/slice.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Values once each, ascending; those within `tolerance` of the one before are that one.
std::vector<double> distinct(std::vector<double> times, double tolerance) {
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end(),
                            [tolerance](double a, double b) { return b - a <= tolerance; }),
                times.end());
    return times;
}

/// The times at which tracks have vertices: centres of splits have no track.
template<int D>
std::vector<double> levels_of(const HullColumns<D>& hull) {
    constexpr std::size_t piece = 1 << 16;
    const double tolerance = time_span(hull).tolerance();
    std::vector<double> levels;
    std::vector<std::int64_t> tracks(piece);
    for (std::size_t begin = 0; begin < hull.points.size(); begin += piece) {
        const std::size_t end = std::min(begin + piece, hull.points.size());
        hull.track_id.fill(begin, end, tracks.data());
        for (std::size_t v = begin; v < end; ++v) {
            if (tracks[v - begin] >= 0) {
                levels.push_back(hull.points[v][D]);
            }
        }
        levels = distinct(std::move(levels), tolerance);
    }
    return levels;
}

/// `count` of them, evenly, with the first and the last.
std::vector<double> some_of(const std::vector<double>& levels, std::size_t count) {
    std::vector<double> some;
    for (std::size_t k = 0; k < count; ++k) {
        some.push_back(levels[k * (levels.size() - 1) / (count - 1)]);
    }
    return some;
}

/// The boundary on one level, its vertices by ascending track, so that equal boundaries are equal lists.
template<int D>
struct Level {
    struct Piece {
        Facet<D> corners; ///< ascending
        bool odd;         ///< it took an odd permutation to sort them
        PatchNumber patch;
        friend auto operator<=>(const Piece&, const Piece&) = default;
    };
    double time = 0;
    std::vector<TrackId> tracks;
    std::vector<PersistentId> ids;
    std::vector<Point<D>> points;
    std::vector<Piece> facets; ///< ascending
};

template<std::size_t N>
bool sort_is_odd(std::array<Index, N>& corners) {
    bool odd = false;
    for (std::size_t i = 1; i < N; ++i) {
        for (std::size_t j = i; j > 0 && corners[j] < corners[j - 1]; --j) {
            std::swap(corners[j], corners[j - 1]);
            odd = !odd;
        }
    }
    return odd;
}

template<int D>
Level<D> level_of(const Section<D>& section) {
    const std::size_t count = section.track_ids.size();
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return section.track_ids[a] < section.track_ids[b]; });
    Level<D> level;
    level.time = section.time;
    std::vector<Index> place(count);
    for (const Index v : order) {
        place[v] = static_cast<Index>(level.tracks.size());
        level.tracks.push_back(section.track_ids[v]);
        level.ids.push_back(section.vertex_ids[v]);
        level.points.push_back(section.surface.points[v]);
    }
    for (std::size_t f = 0; f < section.surface.facets.size(); ++f) {
        Facet<D> corners = section.surface.facets[f];
        for (Index& corner : corners) {
            corner = place[corner];
        }
        const bool odd = sort_is_odd(corners);
        level.facets.push_back({corners, odd, section.surface.patch[f]});
    }
    std::sort(level.facets.begin(), level.facets.end());
    return level;
}

/// Whether the facets of one level move to those of the other.
template<int D>
bool move_on(const Level<D>& lower, const Level<D>& upper) {
    return lower.tracks.front() >= 0 &&
           std::adjacent_find(lower.tracks.begin(), lower.tracks.end()) == lower.tracks.end() &&
           lower.tracks == upper.tracks && lower.facets == upper.facets;
}

template<int D>
class ThinSideMaker {
public:
    /// False when the level does not continue the one before.
    bool add(Level<D> level) {
        if (level.tracks.empty() || (below_ && !move_on(*below_, level))) {
            return false;
        }
        const std::size_t first = side_.points.size();
        add_points(level);
        if (below_) {
            for (const auto& facet : level.facets) {
                add_prism(facet, first);
            }
        }
        below_ = std::move(level);
        ++side_.levels;
        return true;
    }

    ThinSide<D> done() && { return std::move(side_); }

private:
    void add_points(const Level<D>& level) {
        for (std::size_t v = 0; v < level.points.size(); ++v) {
            Point<D + 1> point{};
            std::copy(level.points[v].begin(), level.points[v].end(), point.begin());
            point[D] = level.time;
            side_.points.push_back(point);
            side_.vertex_id.push_back(level.ids[v]);
            side_.track_id.push_back(level.tracks[v]);
        }
    }

    /// Staircases v_0 .. v_k, w_k .. w_(D-1) from the lower corners v to the upper ones w. Their edges, in
    /// terms of the facet's and a step upwards, are an even basis for even D - 1 - k. Outward cells need the
    /// odd one: of the facet's edges, the step and the normal, the last two change places.
    void add_prism(const typename Level<D>::Piece& facet, std::size_t first) {
        const std::size_t below = first - below_->points.size();
        for (std::size_t k = 0; k < D; ++k) {
            Simplex<D> cell{};
            for (std::size_t i = 0; i <= D; ++i) {
                cell[i] =
                    static_cast<Index>(i <= k ? below + facet.corners[i] : first + facet.corners[i - 1]);
            }
            if (facet.odd == ((D - 1 - k) % 2 == 1)) {
                std::swap(cell[0], cell[1]);
            }
            side_.cells.push_back(cell);
            side_.patch.push_back(facet.patch);
        }
    }

    ThinSide<D> side_;
    std::optional<Level<D>> below_;
};

/// Facets on the first level.
template<int D>
std::size_t facets_at(const HullColumns<D>& hull, double time) {
    return slice_hull(hull, time).surface.facets.size();
}

} // namespace

template<int D>
std::optional<ThinSide<D>> thin_side(const HullColumns<D>& hull, std::size_t most) {
    if (!hull.track_id.given() || !hull.vertex_id.given()) {
        return std::nullopt;
    }
    const std::vector<double> levels = levels_of(hull);
    if (levels.size() < 2) {
        return std::nullopt;
    }
    const std::size_t cells_per_layer = D * std::max<std::size_t>(1, facets_at(hull, levels.front()));
    const std::size_t layers = std::clamp<std::size_t>(most / cells_per_layer, 1, levels.size() - 1);
    ThinSideMaker<D> maker;
    bool sound = true;
    slice_hull<D>(hull, some_of(levels, layers + 1),
                  [&](Section<D>&& section) { sound = sound && maker.add(level_of(section)); });
    if (!sound) {
        return std::nullopt;
    }
    ThinSide<D> side = std::move(maker).done();
    side.all_levels = levels.size();
    return side;
}

template std::optional<ThinSide<2>> thin_side<2>(const HullColumns<2>&, std::size_t);
template std::optional<ThinSide<3>> thin_side<3>(const HullColumns<3>&, std::size_t);

} // namespace slabhull
