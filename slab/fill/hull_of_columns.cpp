// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/findings.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/fill.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace slabhull {

namespace {

[[noreturn]] void out_of_order(const char* kind, std::size_t number, const char* why) {
    throw GeometryError{
        fmt::format("{} {} {}: only hulls whose vertices and cells stand as build writes them "
                    "can be filled; one that was renumbered must be built again",
                    kind, number, why),
        {{kind, static_cast<std::int64_t>(number), {}}}};
}

/// Makes one hull.
template<int D>
class HullMaker {
public:
    explicit HullMaker(const HullColumns<D>& columns) : columns_{columns} {}

    Hull<D> run() {
        if (!columns_.track_id.given()) {
            throw GeometryError{"the hull has no array track_id, so that nothing says which vertex became "
                                "which; build it anew, and keep the array where it is converted"};
        }
        hull_.points.assign(columns_.points.begin(), columns_.points.end());
        hull_.cells.assign(columns_.cells.begin(), columns_.cells.end());
        hull_.neighbors = build_adjacency<D>(columns_.cells, columns_.points.size()).neighbors;
        hull_.track_ids = read_ids(columns_.track_id);
        if (columns_.vertex_id.given()) {
            hull_.vertex_ids = read_ids(columns_.vertex_id);
        } else {
            hull_.vertex_ids.append_run(0, hull_.points.size(), 1);
        }
        hull_.patches = columns_.patches;
        find_times();
        part_points();
        part_cells();
        part_side();
        return std::move(hull_);
    }

private:
    void find_times() {
        hull_.time = {hull_.points.front()[D], hull_.points.front()[D]};
        for (const Point<D + 1>& point : hull_.points) {
            hull_.time = {std::min(hull_.time[0], point[D]), std::max(hull_.time[1], point[D])};
        }
    }

    void part_points() {
        const auto part = [&](const Point<D + 1>& p) {
            return p[D] == hull_.time[0] ? 0 : p[D] == hull_.time[1] ? 2 : 1;
        };
        int last = 0;
        for (std::size_t v = 0; v < hull_.points.size(); ++v) {
            const int now = part(hull_.points[v]);
            if (now < last) {
                out_of_order("vertex", v, "comes after vertices of later parts of the hull");
            }
            last = now;
            hull_.initial_points += now == 0 ? 1 : 0;
            hull_.side_points += now == 1 ? 1 : 0;
        }
    }

    Region region(const Simplex<D>& cell) const {
        const auto all = [&](double t) {
            return std::all_of(cell.begin(), cell.end(), [&](Index v) { return hull_.points[v][D] == t; });
        };
        return all(hull_.time[0])   ? Region::initial
               : all(hull_.time[1]) ? Region::terminating
                                    : Region::intermediate;
    }

    void part_cells() {
        Region last = Region::initial;
        for (std::size_t c = 0; c < hull_.cells.size(); ++c) {
            const Region now = region(hull_.cells[c]);
            if (now < last) {
                out_of_order("cell", c, "comes after cells of later regions");
            }
            last = now;
            hull_.initial_cells += now == Region::initial ? 1 : 0;
            hull_.side_cells += now == Region::intermediate ? 1 : 0;
        }
    }

    /// Divides the side into prisms of equal length, by layer, then by facet of the initial cap's boundary.
    void part_side() {
        std::set<double> levels{hull_.time[0], hull_.time[1]};
        for (std::size_t v = hull_.initial_points; v < hull_.terminating_points_begin(); ++v) {
            if (hull_.track_ids[v] != no_track) {
                levels.insert(hull_.points[v][D]);
            }
        }
        hull_.layers = levels.size() - 1;
        std::size_t facets = 0;
        for (std::size_t c = 0; c < hull_.initial_cells; ++c) {
            for (const Index across : hull_.neighbors[c]) {
                facets += across >= hull_.initial_cells ? 1 : 0;
            }
        }
        std::vector<double> times(levels.begin(), levels.end());
        if (facets == 0 || hull_.side_cells % (facets * hull_.layers) != 0 || has_new_tracks()) {
            part_changing_side(times);
            return;
        }
        hull_.cells_per_prism = hull_.side_cells / (facets * hull_.layers);
        hull_.facet_patch.resize(facets);
        require_prisms(times);
        read_patches();
    }

    /// The side of a boundary that changes its connectivity: runs of cells of one patch in one layer.
    void part_changing_side(const std::vector<double>& times) {
        std::vector<std::int64_t> patch(hull_.side_cells, 0);
        if (columns_.patch.given()) {
            columns_.patch.fill(hull_.initial_cells, hull_.terminating_begin(), patch.data());
        }
        hull_.cells_per_prism = 0;
        for (std::size_t k = 0; k < hull_.side_cells; ++k) {
            const std::size_t c = hull_.initial_cells + k;
            double first = hull_.time[1];
            for (const Index v : hull_.cells[c]) {
                first = std::min(first, hull_.points[v][D]);
            }
            const auto layer = static_cast<std::int32_t>(std::upper_bound(times.begin(), times.end(), first) -
                                                         times.begin() - 1);
            const auto number = static_cast<PatchNumber>(patch[k]);
            std::vector<SidePart>& parts = hull_.side_parts;
            if (parts.empty() || parts.back().layer != layer || parts.back().patch != number) {
                parts.push_back({static_cast<Index>(c), number, layer});
            }
        }
    }

    /// Whether the side has tracks that the initial cap does not have.
    bool has_new_tracks() const {
        std::vector<std::int64_t> tracks(hull_.terminating_points_begin());
        hull_.track_ids.copy(0, tracks.size(), tracks.data());
        const auto side = tracks.begin() + static_cast<std::ptrdiff_t>(hull_.initial_points);
        std::sort(tracks.begin(), side);
        return std::any_of(side, tracks.end(), [&](std::int64_t track) {
            return track != no_track && !std::binary_search(tracks.begin(), side, track);
        });
    }

    /// Checks that each prism stands on the columns of its facet, between the levels of its layer.
    void require_prisms(const std::vector<double>& times) {
        const std::size_t facets = hull_.facet_patch.size();
        std::vector<std::array<TrackId, D>> tracks(facets);
        std::vector<std::uint8_t> met(facets, 0);
        for (std::size_t c = 0; c < hull_.initial_cells; ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                const Index across = hull_.neighbors[c][i];
                if (across < hull_.initial_cells) {
                    continue;
                }
                const std::size_t facet = (across - hull_.initial_cells) / hull_.cells_per_prism;
                if (facet >= facets || met[facet]++ != 0) {
                    out_of_order("cell", across, "is in another prism than its place says");
                }
                std::size_t k = 0;
                for (std::size_t j = 0; j <= D; ++j) {
                    if (j != i) {
                        tracks[facet][k++] = hull_.track_ids[hull_.cells[c][j]];
                    }
                }
            }
        }
        for (std::size_t c = hull_.initial_cells; c < hull_.terminating_begin(); ++c) {
            const std::size_t prism = (c - hull_.initial_cells) / hull_.cells_per_prism;
            const auto& own = tracks[prism % facets];
            for (const Index v : hull_.cells[c]) {
                const TrackId track = hull_.track_ids[v];
                const double t = hull_.points[v][D];
                if ((track != no_track && std::find(own.begin(), own.end(), track) == own.end()) ||
                    t < times[prism / facets] || t > times[prism / facets + 1]) {
                    out_of_order("cell", c, "is in another prism than its place says");
                }
            }
        }
    }

    void read_patches() {
        std::vector<std::int64_t> patch(1, 0);
        for (std::size_t f = 0; f < hull_.facet_patch.size(); ++f) {
            const std::size_t c = hull_.initial_cells + f * hull_.cells_per_prism;
            if (columns_.patch.given()) {
                columns_.patch.fill(c, c + 1, patch.data());
            }
            hull_.facet_patch[f] = static_cast<PatchNumber>(patch[0]);
        }
    }

    const HullColumns<D>& columns_;
    Hull<D> hull_;
};

} // namespace

template<int D>
Hull<D> hull_of_columns(const HullColumns<D>& columns) {
    return HullMaker<D>{columns}.run();
}

template Hull<2> hull_of_columns<2>(const HullColumns<2>&);
template Hull<3> hull_of_columns<3>(const HullColumns<3>&);

} // namespace slabhull
