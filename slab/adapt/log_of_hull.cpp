// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapt_cap.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace slabhull {

namespace {

/// Adapts the initial cap of one hull again.
template<int D>
class AdaptationReplay {
public:
    explicit AdaptationReplay(const Hull<D>& hull) : hull_{hull}, tracks_(hull.points.size()) {
        hull.track_ids.copy(0, tracks_.size(), tracks_.data());
    }

    AdaptLog<D> run() {
        const SpatialMesh<D> initial = initial_cap();
        find_boundary(initial);
        find_levels();
        if (vertices_.size() != hull_.adapt_spacing.size()) {
            refuse("its targets are not of the vertices on its boundary");
        }
        const std::span<const TrackId> own{tracks_.data(), hull_.initial_points};
        AdaptedCap<D> cap = adapt_cap<D>(initial, own, {vertices_, times_, positions_, hull_.adapt_spacing},
                                         settings_of_numbers(hull_.adapt_settings));
        give_new_tracks(first_new_track(), cap.columns, cap.log);
        require_same(cap);
        return std::move(cap.log);
    }

private:
    [[noreturn]] static void refuse(const char* why) {
        throw GeometryError{
            fmt::format("the hull's cap was adapted, but the changes cannot be made again: {}; "
                        "build the slab anew with this version, and [fill] in the case file",
                        why)};
    }

    SpatialMesh<D> initial_cap() const {
        SpatialMesh<D> cap;
        for (std::size_t v = 0; v < hull_.initial_points; ++v) {
            cap.points.push_back(in_space(hull_.points[v]));
        }
        for (std::size_t c = 0; c < hull_.initial_cells; ++c) {
            cap.cells.push_back(hull_.cells[c]);
            cap.neighbors.push_back(hull_.neighbors[c]);
            std::swap(cap.cells[c][0], cap.cells[c][1]); // the hull's cells face back in time
            std::swap(cap.neighbors[c][0], cap.neighbors[c][1]);
            for (Index& across : cap.neighbors[c]) {
                across = across < hull_.initial_cells ? across : no_index;
            }
        }
        return cap;
    }

    static Point<D> in_space(const Point<D + 1>& point) {
        Point<D> place;
        std::copy_n(point.begin(), D, place.begin());
        return place;
    }

    /// The boundary's vertices in the order of the sweep, with which the terminating cap begins.
    void find_boundary(const SpatialMesh<D>& cap) {
        std::map<TrackId, Index> at_track;
        for (std::size_t c = 0; c < cap.cells.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                for (std::size_t k = 0; k <= D && cap.neighbors[c][i] == no_index; ++k) {
                    if (k != i) {
                        at_track.emplace(tracks_[cap.cells[c][k]], cap.cells[c][k]);
                    }
                }
            }
        }
        const std::size_t first = hull_.terminating_points_begin();
        for (std::size_t b = 0; b < at_track.size(); ++b) {
            const auto found =
                first + b < tracks_.size() ? at_track.find(tracks_[first + b]) : at_track.end();
            if (found == at_track.end()) {
                refuse("its terminating cap does not begin with the vertices of the boundary");
            }
            vertices_.push_back(found->second);
            place_of_track_.emplace(found->first, b);
        }
    }

    void find_levels() {
        std::map<double, std::vector<Index>> between;
        for (std::size_t v = hull_.initial_points; v < hull_.terminating_points_begin(); ++v) {
            if (tracks_[v] != no_track) {
                between[hull_.points[v][D]].push_back(static_cast<Index>(v));
            }
        }
        const auto add = [&](double time, const auto& vertex_at) {
            times_.push_back(time);
            Array<Point<D>>& places = positions_.emplace_back();
            for (std::size_t b = 0; b < vertices_.size(); ++b) {
                places.push_back(in_space(hull_.points[vertex_at(b)]));
            }
        };
        add(hull_.time[0], [&](std::size_t b) { return vertices_[b]; });
        for (const auto& [time, on_level] : between) {
            std::vector<Index> vertex(vertices_.size(), no_index);
            for (const Index v : on_level) {
                const auto place = place_of_track_.find(tracks_[v]);
                if (place == place_of_track_.end()) {
                    refuse("a vertex of the side is on no track of the boundary");
                }
                vertex[place->second] = v;
            }
            if (std::find(vertex.begin(), vertex.end(), no_index) != vertex.end()) {
                refuse("a track of the boundary is missing on a level");
            }
            add(time, [&](std::size_t b) { return vertex[b]; });
        }
        add(hull_.time[1],
            [&](std::size_t b) { return static_cast<Index>(hull_.terminating_points_begin() + b); });
    }

    /// Ids of the terminating cap are followed by the tracks of the vertices that operations made.
    TrackId first_new_track() const {
        std::int64_t last = -1;
        hull_.vertex_ids.copy(hull_.points.size() - 1, hull_.points.size(), &last);
        return last + 1;
    }

    void require_same(const AdaptedCap<D>& cap) const {
        const std::size_t first_point = hull_.terminating_points_begin();
        const std::size_t first_cell = hull_.terminating_begin();
        bool same = cap.mesh.points.size() == hull_.points.size() - first_point &&
                    cap.mesh.cells.size() == hull_.cells.size() - first_cell;
        for (std::size_t v = 0; same && v < cap.mesh.points.size(); ++v) {
            same = cap.mesh.points[v] == in_space(hull_.points[first_point + v]) &&
                   cap.log.tracks[cap.column[v]] == tracks_[first_point + v];
        }
        for (std::size_t c = 0; same && c < cap.mesh.cells.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                same = same && cap.mesh.cells[c][i] + first_point == hull_.cells[first_cell + c][i];
            }
        }
        if (!same) {
            refuse("they do not lead to its terminating cap");
        }
    }

    const Hull<D>& hull_;
    std::vector<TrackId> tracks_;
    std::vector<Index> vertices_; ///< of the initial cap, in the order of the sweep's boundary
    std::map<TrackId, std::size_t> place_of_track_;
    std::vector<double> times_;
    std::vector<Array<Point<D>>> positions_;
};

} // namespace

template<int D>
AdaptLog<D> log_of_hull(const Hull<D>& hull) {
    return AdaptationReplay<D>{hull}.run();
}

template AdaptLog<2> log_of_hull<2>(const Hull<2>&);
template AdaptLog<3> log_of_hull<3>(const Hull<3>&);

} // namespace slabhull
