// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/slab_columns.h"

#include "core/listed.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t items_per_piece = 1 << 14;
constexpr std::size_t most_named = 10;

std::vector<Entity> entities_of(const char* kind, const std::vector<Index>& numbers) {
    std::vector<Entity> entities;
    for (std::size_t k = 0; k < std::min(numbers.size(), most_named); ++k) {
        entities.push_back({kind, numbers[k], {}});
    }
    return entities;
}

[[noreturn]] void refuse(const std::string& what, const char* kind, const std::vector<Index>& at_fault) {
    throw GeometryError(fmt::format("{} {} {}: the hull alone cannot be filled, since its caps are not one "
                                    "mesh moved. A cap that was meshed anew has none before it; build with "
                                    "cap.reuse = \"move\" or \"adapt\". One that was adapted is filled from "
                                    "its VTU file, or by `build` with [fill] in the case file",
                                    what, kind, listed(at_fault, most_named)),
                        entities_of(kind, at_fault));
}

/// A vertex on its track.
struct OnTrack {
    TrackId track;
    Index vertex;
    friend auto operator<=>(const OnTrack&, const OnTrack&) = default;
};

/// Vertices [begin, end) by ascending track. With `all`, each must have one.
template<int D>
std::vector<OnTrack> by_track(const Hull<D>& hull, std::size_t begin, std::size_t end, bool all) {
    std::vector<OnTrack> result;
    result.reserve(end - begin);
    std::vector<TrackId> tracks(end - begin);
    hull.track_ids.copy(begin, end, tracks.data());
    std::vector<Index> without;
    for (std::size_t v = begin; v < end; ++v) {
        if (tracks[v - begin] != no_track) {
            result.push_back({tracks[v - begin], static_cast<Index>(v)});
        } else if (all) {
            without.push_back(static_cast<Index>(v));
        }
    }
    if (!without.empty()) {
        refuse(fmt::format("the cap at t = {} has {} vertices without a track,", hull.points[begin][D],
                           without.size()),
               "vertex", without);
    }
    std::sort(result.begin(), result.end());
    return result;
}

/// Finds the columns of one hull.
template<int D>
class ColumnFinder {
public:
    ColumnFinder(const Hull<D>& hull, Filling<D>& filling) : hull_{hull}, filling_{filling} {}

    SlabColumns<D> run() {
        first_ = by_track(hull_, 0, hull_.initial_points, true);
        columns_.count = first_.size();
        column_of_.assign(hull_.points.size(), no_index);
        for (std::size_t k = 0; k < first_.size(); ++k) {
            column_of_[first_[k].vertex] = static_cast<Index>(k);
        }
        find_levels();
        place_ends();
        place_between();
        number_inside();
        sort_cells();
        compare_caps();
        return std::move(columns_);
    }

private:
    /// Finds the vertices on inner levels and the times of all levels.
    void find_levels() {
        between_ = by_track(hull_, hull_.initial_points, hull_.terminating_points_begin(), false);
        std::vector<double>& times = columns_.times;
        for (const OnTrack& at : between_) {
            times.push_back(hull_.points[at.vertex][D]);
        }
        times.insert(times.end(), hull_.time.begin(), hull_.time.end());
        std::sort(times.begin(), times.end());
        times.erase(std::unique(times.begin(), times.end()), times.end());
        if (columns_.layers() != hull_.layers) {
            throw GeometryError{
                fmt::format("the hull has {} layers, but its side's vertices are on {} levels; "
                            "check it first",
                            hull_.layers, times.size())};
        }
        checked_index(hull_.points.size() + times.size() * columns_.count, "vertices of the filling");
        columns_.vertex.assign(times.size() * columns_.count, no_index);
    }

    Index& at(std::size_t level, Index column) { return columns_.vertex[level * columns_.count + column]; }

    /// no_index for a track that does not start at the initial cap.
    Index column_of(TrackId track) const {
        const auto found = std::lower_bound(first_.begin(), first_.end(), OnTrack{track, 0});
        return found != first_.end() && found->track == track ? static_cast<Index>(found - first_.begin())
                                                              : no_index;
    }

    void place_ends() {
        for (std::size_t k = 0; k < first_.size(); ++k) {
            at(0, static_cast<Index>(k)) = first_[k].vertex;
        }
        const std::vector<OnTrack> last =
            by_track(hull_, hull_.terminating_points_begin(), hull_.points.size(), true);
        std::vector<Index> strangers;
        for (const OnTrack& end : last) {
            const Index column = column_of(end.track);
            if (column == no_index) {
                strangers.push_back(end.vertex);
            } else {
                at(columns_.layers(), column) = end.vertex;
                column_of_[end.vertex] = column;
            }
        }
        if (!strangers.empty()) {
            refuse(fmt::format("{} vertices of the terminating cap are on no track of the initial one,",
                               strangers.size()),
                   "vertex", strangers);
        }
        std::vector<Index> ended;
        for (const OnTrack& start : first_) {
            if (at(columns_.layers(), column_of_[start.vertex]) == no_index) {
                ended.push_back(start.vertex);
            }
        }
        if (!ended.empty()) {
            refuse(fmt::format("the tracks of {} vertices of the initial cap end before the terminating one,",
                               ended.size()),
                   "vertex", ended);
        }
    }

    void place_between() {
        columns_.on_boundary.assign(columns_.count, 0);
        for (std::size_t c = 0; c < hull_.initial_cells; ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (hull_.neighbors[c][i] >= hull_.initial_cells) {
                    for (std::size_t k = 0; k <= D; ++k) {
                        std::uint8_t& on = columns_.on_boundary[column_of_[hull_.cells[c][k]]];
                        on = k == i ? on : 1;
                    }
                }
            }
        }
        std::vector<Index> stray;
        for (const OnTrack& between : between_) {
            const Index column = column_of(between.track);
            if (column == no_index || columns_.on_boundary[column] == 0) {
                stray.push_back(between.vertex);
                continue;
            }
            const double t = hull_.points[between.vertex][D];
            const auto level =
                std::lower_bound(columns_.times.begin(), columns_.times.end(), t) - columns_.times.begin();
            at(static_cast<std::size_t>(level), column) = between.vertex;
        }
        if (!stray.empty()) {
            refuse("on the side there are tracks that the initial cap's boundary has not,", "vertex", stray);
        }
    }

    /// Numbers the inner vertices on inner levels, after the hull's.
    void number_inside() {
        auto next = static_cast<Index>(hull_.points.size());
        for (std::size_t level = 1; level < columns_.layers(); ++level) {
            for (Index column = 0; column < columns_.count; ++column) {
                Index& vertex = at(level, column);
                if (columns_.on_boundary[column] != 0 && vertex == no_index) {
                    refuse(fmt::format("there is no vertex at t = {} on the track of", columns_.times[level]),
                           "vertex", {first_[column].vertex});
                }
                vertex = columns_.on_boundary[column] != 0 ? vertex : next++;
            }
        }
        filling_.points.resize(next);
        std::copy(hull_.points.begin(), hull_.points.end(), filling_.points.begin());
    }

    void sort_cells() {
        columns_.cells.resize(hull_.initial_cells);
        columns_.odd.resize(hull_.initial_cells);
        columns_.neighbors.resize(hull_.initial_cells);
        columns_.swept_facet.resize(hull_.initial_cells);
        parallel_for(hull_.initial_cells, items_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                sort_cell(c);
            }
        });
    }

    void sort_cell(std::size_t c) {
        std::array<std::pair<Index, std::size_t>, D + 1> order;
        for (std::size_t i = 0; i <= D; ++i) {
            order[i] = {column_of_[hull_.cells[c][i]], i};
        }
        std::uint8_t odd = 1; // a cell of the initial cap is negative in space
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                odd ^= order[j] > order[i] ? 1 : 0;
            }
        }
        std::sort(order.begin(), order.end());
        columns_.odd[c] = odd;
        for (std::size_t k = 0; k <= D; ++k) {
            const Index across = hull_.neighbors[c][order[k].second];
            const bool inside = across < hull_.initial_cells;
            columns_.cells[c][k] = order[k].first;
            columns_.neighbors[c][k] = inside ? across : no_index;
            columns_.swept_facet[c][k] =
                inside ? no_index
                       : static_cast<Index>((across - hull_.initial_cells) / hull_.cells_per_prism %
                                            hull_.facet_patch.size());
        }
    }

    Simplex<D> columns_of_cell(std::size_t cell) const {
        Simplex<D> result;
        for (std::size_t i = 0; i <= D; ++i) {
            result[i] = column_of_[hull_.cells[cell][i]];
        }
        std::sort(result.begin(), result.end());
        return result;
    }

    /// Checks that both caps have the same cells, in any order.
    void compare_caps() const {
        const std::size_t begin = hull_.terminating_begin();
        std::vector<Index> lost; // cells whose partner of the same number differs
        std::vector<std::pair<Simplex<D>, Index>> images;
        const std::size_t common = std::min(hull_.initial_cells, hull_.cells.size() - begin);
        for (std::size_t c = 0; c < common; ++c) {
            Simplex<D> image = columns_of_cell(begin + c);
            if (image != columns_.cells[c]) {
                lost.push_back(static_cast<Index>(c));
                images.emplace_back(image, static_cast<Index>(begin + c));
            }
        }
        for (std::size_t c = common; c < hull_.initial_cells; ++c) {
            lost.push_back(static_cast<Index>(c));
        }
        for (std::size_t c = begin + common; c < hull_.cells.size(); ++c) {
            images.emplace_back(columns_of_cell(c), static_cast<Index>(c));
        }
        require_same(lost, std::move(images));
    }

    /// `lost` and `images` are the cells of the caps that differ when numbers are compared.
    void require_same(const std::vector<Index>& lost,
                      std::vector<std::pair<Simplex<D>, Index>> images) const {
        std::sort(images.begin(), images.end());
        std::vector<std::uint8_t> met(images.size(), 0);
        std::vector<Index> differ;
        for (const Index c : lost) {
            const auto image =
                std::lower_bound(images.begin(), images.end(), std::pair{columns_.cells[c], Index{0}});
            if (image != images.end() && image->first == columns_.cells[c]) {
                met[static_cast<std::size_t>(image - images.begin())] = 1;
            } else {
                differ.push_back(c);
            }
        }
        for (std::size_t k = 0; k < images.size(); ++k) {
            if (met[k] == 0) {
                differ.push_back(images[k].second);
            }
        }
        if (!differ.empty()) {
            std::sort(differ.begin(), differ.end());
            refuse(fmt::format("{} cells of the caps have no image in the other cap,", differ.size()), "cell",
                   differ);
        }
    }

    const Hull<D>& hull_;
    Filling<D>& filling_;
    SlabColumns<D> columns_;
    std::vector<OnTrack> first_;   ///< vertices of the initial cap, by track
    std::vector<OnTrack> between_; ///< vertices on the side's inner levels
    std::vector<Index> column_of_; ///< column of each of the hull's cap vertices
};

} // namespace

template<int D>
SlabColumns<D> slab_columns(const Hull<D>& hull, Filling<D>& filling) {
    return ColumnFinder<D>{hull, filling}.run();
}

template SlabColumns<2> slab_columns<2>(const Hull<2>&, Filling<2>&);
template SlabColumns<3> slab_columns<3>(const Hull<3>&, Filling<3>&);

} // namespace slabhull
