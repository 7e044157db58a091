// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapt_cap.h"

#include "core/place_in_words.h"
#include "slab/adapt/adapt_mesh.h"
#include "slab/adapt/adapt_round.h"
#include "slab/adapt/cell_quality.h"
#include "slab/adapt/vertex_smoother.h"
#include "slab/sweep/swept_first.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/geometry/cap_motion.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/size_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace slabhull {

namespace {

/// Adapts one cap.
template<int D>
class CapAdapter {
public:
    CapAdapter(const SpatialMesh<D>& initial, std::span<const TrackId> tracks, const CapBoundary<D>& boundary,
               const AdaptOptions& options)
        : boundary_{boundary}, options_{options} {
        open(initial, tracks);
        set_targets();
        if (options.boundary && boundary.motion != nullptr) {
            adapted_boundary_.emplace(*boundary.motion, boundary.times, boundary.positions, boundary.spacing,
                                      mesh_);
            result_.report.boundary_ratios_before = adapted_boundary_->length_ratios();
        }
    }

    AdaptedCap<D> run() {
        note_level();
        for (std::size_t layer = 0; layer < layers(); ++layer) {
            go_on();
            move(layer);
            change(layer);
            note_level();
        }
        finish();
        return std::move(result_);
    }

private:
    std::size_t layers() const { return boundary_.times.size() - 1; }

    /// Numbers the vertices by ascending track.
    void open(const SpatialMesh<D>& initial, std::span<const TrackId> tracks) {
        const std::size_t count = initial.points.size();
        std::vector<Index> vertices(count);
        std::iota(vertices.begin(), vertices.end(), Index{0});
        std::sort(vertices.begin(), vertices.end(), [&](Index a, Index b) { return tracks[a] < tracks[b]; });
        std::vector<Index> column_of(count);
        for (std::size_t k = 0; k < count; ++k) {
            column_of[vertices[k]] = static_cast<Index>(k);
            mesh_.now.push_back(initial.points[vertices[k]]);
            result_.log.tracks.push_back(tracks[vertices[k]]);
        }
        mesh_.column.resize(count);
        std::iota(mesh_.column.begin(), mesh_.column.end(), Index{0});
        mesh_.on_boundary.assign(count, 0);
        for (const Index v : boundary_.vertices) {
            mesh_.boundary.push_back(column_of[v]);
            mesh_.on_boundary[column_of[v]] = 1;
        }
        mesh_.cells = initial.cells;
        for (Simplex<D>& cell : mesh_.cells) {
            for (Index& v : cell) {
                v = column_of[v];
            }
        }
        mesh_.neighbors = initial.neighbors;
        mesh_.find_cells_of_vertices();
        result_.columns = static_cast<Index>(count);
        result_.log.cells = mesh_.cells;
        result_.log.times = boundary_.times;
    }

    /// Vertices keep their targets through the slab; new ones take those of their edge.
    void set_targets() {
        const std::span<const double> spacing = boundary_.spacing;
        const SizeField<D> sizes{boundary_.positions.front(), spacing, {options_.growth, options_.size}};
        // Cells on the boundary are as large as its facets: max over y of (h_y - |x - y|) is a lower bound,
        // which is the same field for the spacings below their maximum.
        const double most = 1.001 * *std::max_element(spacing.begin(), spacing.end());
        std::vector<double> below_most(spacing.size());
        std::transform(spacing.begin(), spacing.end(), below_most.begin(),
                       [&](double h) { return most - h; });
        const SizeField<D> gaps{boundary_.positions.front(), below_most, {1, most}};
        mesh_.target.resize(mesh_.now.size());
        parallel_for(mesh_.target.size(), 1 << 13, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                mesh_.target[v] = std::max(sizes(mesh_.now[v]), most - gaps(mesh_.now[v]));
            }
        });
    }

    void note_level() {
        result_.log.columns.push_back(mesh_.column);
        result_.log.places.push_back(mesh_.now);
    }

    void move(std::size_t layer) {
        constexpr int most_passes = 6;
        mesh_.before = mesh_.now;
        CapMotionOptions careful;
        careful.tolerance = careful_tolerance;
        const Array<Point<D>>& end =
            adapted_boundary_ ? adapted_boundary_->move(layer) : boundary_.positions[layer + 1];
        mesh_.now = move_cap<D>(mesh_.before, mesh_.cells, mesh_.boundary, end, careful).points;
        VertexSmoother<D> smoother{mesh_};
        constexpr double least =
            5; // degrees: cells that are no good for a layer are mended whatever is aimed at
        const double good = quality_of_angle(std::max(least, 1.8 * options_.angle));
        result_.report.moved += smoother.run(good);
        std::vector<Index> unsound = smoother.unsound();
        for (int pass = 1; pass < most_passes && !unsound.empty(); ++pass) {
            smoother.run(good);
            unsound = smoother.unsound();
        }
        if (!unsound.empty()) {
            refuse(unsound, layer);
        }
    }

    [[noreturn]] void refuse(const std::vector<Index>& cells, std::size_t layer) const {
        constexpr std::size_t most_named = 8;
        std::vector<Entity> entities;
        std::string names;
        for (std::size_t k = 0; k < std::min(cells.size(), most_named); ++k) {
            for (const Index v : mesh_.cells[cells[k]]) {
                const Index column = mesh_.column[v];
                if (column < result_.log.tracks.size()) {
                    entities.push_back({"track", result_.log.tracks[column], {}});
                }
            }
            const Point<D>& place = mesh_.now[mesh_.cells[cells[k]][0]];
            names += fmt::format("{} {}", k == 0 ? "" : ",", place_in_words(place));
        }
        throw InvertedCap{
            fmt::format("{} of the cap's cells would be inside out between t = {} and {}, near{}; "
                        "shorter slabs (time.slabs), more layers (time.layers), smaller cells "
                        "(cap.size) or a larger adapt.angle may do",
                        cells.size(), boundary_.times[layer], boundary_.times[layer + 1], names),
            std::move(entities)};
    }

    void change(std::size_t layer) {
        const std::array<double, 2> times{boundary_.times[layer], boundary_.times[layer + 1]};
        if (!adapted_boundary_) {
            const auto cavities = choose_operations<D>(mesh_, nullptr, times, options_, result_.report);
            mesh_.apply(cavities, result_.columns, result_.log);
            return;
        }
        const BoundaryOperations<D> on_boundary = adapted_boundary_->operations(layer, mesh_, options_);
        const auto cavities = choose_operations<D>(mesh_, &on_boundary, times, options_, result_.report);
        try {
            adapted_boundary_->change(layer, cavities, mesh_, result_.columns);
        } catch (const GeometryError& error) {
            throw InvertedCap{error.what(), error.entities}; // more layers may help
        }
        mesh_.apply(cavities, result_.columns, result_.log);
        mesh_.boundary = adapted_boundary_->vertices_in(mesh_);
    }

    /// The mesh with the swept vertices first.
    void finish() {
        const std::size_t count = mesh_.now.size();
        const std::vector<Index> number = swept_first(count, mesh_.boundary);
        CapMesh<D>& cap = result_.mesh;
        cap.points.resize(count);
        result_.column.resize(count);
        for (std::size_t v = 0; v < count; ++v) {
            cap.points[number[v]] = mesh_.now[v];
            result_.column[number[v]] = mesh_.column[v];
        }
        const auto measures = measure_solid<D>(mesh_.now, mesh_.cells);
        result_.report.smallest_angle = measures.angles.smallest;
        const auto ratios = length_ratios<D>(mesh_);
        result_.report.shortest_ratio = ratios[0];
        result_.report.longest_ratio = ratios[1];
        cap.cells = std::move(mesh_.cells);
        for (Simplex<D>& cell : cap.cells) {
            for (Index& v : cell) {
                v = number[v];
            }
        }
        cap.neighbors = std::move(mesh_.neighbors);
        if (adapted_boundary_) {
            result_.report.boundary_ratios = adapted_boundary_->length_ratios();
            if (adapted_boundary_->changed()) {
                result_.side = std::move(*adapted_boundary_).sweep();
            }
        }
    }

    const CapBoundary<D>& boundary_;
    const AdaptOptions& options_;
    AdaptMesh<D> mesh_;
    AdaptedCap<D> result_;
    std::optional<AdaptedBoundary<D>> adapted_boundary_;
};

} // namespace

template<int D>
AdaptedCap<D> adapt_cap(const SpatialMesh<D>& initial, std::span<const TrackId> tracks,
                        const CapBoundary<D>& boundary, const AdaptOptions& options) {
    return CapAdapter<D>{initial, tracks, boundary, options}.run();
}

template<int D>
void give_new_tracks(TrackId first, Index columns, AdaptLog<D>& log) {
    while (log.tracks.size() < columns) {
        log.tracks.push_back(first++);
    }
}

std::vector<double> settings_as_numbers(const AdaptOptions& options) {
    return {std::isfinite(options.size) ? options.size : 0, options.growth, options.angle, options.shortest,
            options.longest};
}

AdaptOptions settings_of_numbers(const std::vector<double>& numbers) {
    if (numbers.size() != 5 ||
        !std::all_of(numbers.begin(), numbers.end(), [](double x) { return x >= 0; })) {
        throw GeometryError{
            fmt::format("the hull has {} settings of adaptation, not five numbers from 0; build "
                        "it anew",
                        numbers.size())};
    }
    AdaptOptions options;
    options.size = numbers[0] > 0 ? numbers[0] : std::numeric_limits<double>::infinity();
    options.growth = numbers[1];
    options.angle = numbers[2];
    options.shortest = numbers[3];
    options.longest = numbers[4];
    return options;
}

template AdaptedCap<2> adapt_cap<2>(const SpatialMesh<2>&, std::span<const TrackId>, const CapBoundary<2>&,
                                    const AdaptOptions&);
template AdaptedCap<3> adapt_cap<3>(const SpatialMesh<3>&, std::span<const TrackId>, const CapBoundary<3>&,
                                    const AdaptOptions&);
template void give_new_tracks<2>(TrackId, Index, AdaptLog<2>&);
template void give_new_tracks<3>(TrackId, Index, AdaptLog<3>&);

} // namespace slabhull
