// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapted_boundary.h"

#include "slab/sweep/boundary_mover.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/slab/tangling.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace slabhull {

namespace {

/// Stands for the track that a new vertex gets when the slab is stitched: above all others, and in the same
/// order, since diagonals follow from the order of tracks.
TrackId provisional_track(Index column) {
    return (TrackId{1} << 62) + column;
}

} // namespace

template<int D>
AdaptedBoundary<D>::AdaptedBoundary(const BoundaryMotion<D>& motion, const std::vector<double>& times,
                                    const std::vector<Array<Point<D>>>& positions,
                                    std::span<const double> spacing, const AdaptMesh<D>& mesh)
    : motion_{motion}, times_{times}, positions_{positions}, surfaces_{motion.motions, motion.motion_start,
                                                                       extent_of<D>(positions.front())},
      boundary_{motion.boundary}, spacing_(spacing.begin(), spacing.end()), places_{positions.front()} {
    for (const Index v : mesh.boundary) {
        columns_.push_back(mesh.column[v]);
    }
    sweep_.times = times;
    sweep_.places.push_back(places_);
}

template<int D>
const Array<Point<D>>& AdaptedBoundary<D>::move(std::size_t layer) {
    if (!changed_) {
        end_ = positions_[layer + 1];
        return end_;
    }
    Sweep<D> sweep;
    sweep.boundary = boundary_;
    sweep.times = {times_[layer], times_[layer + 1]};
    sweep.positions.push_back(places_);
    BoundaryMover<D> mover{sweep, motion_.motions, motion_.motion_start, motion_.trajectory};
    end_ = mover.move(places_, times_[layer], times_[layer + 1]);
    sweep.positions.push_back(end_);
    require_embedded_levels<D>(sweep, motion_.motions, motion_.motion_start, motion_.trajectory);
    return end_;
}

template<int D>
BoundaryOperations<D> AdaptedBoundary<D>::operations(std::size_t layer, const AdaptMesh<D>& mesh,
                                                     const AdaptOptions& options) const {
    return {mesh, boundary_, spacing_, surfaces_, {times_[layer], times_[layer + 1]}, options};
}

/// The arrays of a boundary that is to be opened.
template<int D>
struct AdaptedBoundary<D>::Opened {
    Surface<D> surface; ///< at the start of the motion
    std::vector<Index> columns;
    Array<TrackId> tracks;
    Array<double> spacing;
    Array<Point<D>> places;
    std::vector<Index> before; ///< of each vertex of the mesh, its number in the boundary before ...
    std::vector<Index> number; ///< ... and in this one

    Index add(Index column, TrackId track, double length, const Point<D>& start, const Point<D>& place) {
        surface.points.push_back(start);
        columns.push_back(column);
        tracks.push_back(track);
        spacing.push_back(length);
        places.push_back(place);
        return static_cast<Index>(columns.size() - 1);
    }
};

/// The vertices and facets that stay.
template<int D>
typename AdaptedBoundary<D>::Opened AdaptedBoundary<D>::remaining(std::span<const Cavity<D>> cavities,
                                                                  const AdaptMesh<D>& mesh) const {
    std::vector<std::uint8_t> ends(mesh.now.size(), 0);
    std::vector<std::uint8_t> goes(boundary_.facet_count(), 0);
    for (const Cavity<D>& cavity : cavities) {
        if (cavity.ended != no_index) {
            ends[cavity.ended] = 1;
        }
        for (const Index f : cavity.side.removed) {
            goes[f] = 1;
        }
    }
    Opened opened;
    opened.before.assign(mesh.now.size(), no_index);
    opened.number = opened.before;
    opened.surface.patches = boundary_.patches();
    for (Index v = 0; v < columns_.size(); ++v) {
        const Index vertex = mesh.boundary[v];
        opened.before[vertex] = v;
        if (ends[vertex] == 0) {
            opened.number[vertex] =
                opened.add(columns_[v], boundary_.tracks()[v], spacing_[v], boundary_.start()[v], end_[v]);
        }
    }
    for (std::size_t f = 0; f < goes.size(); ++f) {
        if (goes[f] == 0) {
            Facet<D> facet = boundary_.facets()[f];
            for (Index& v : facet) {
                v = opened.number[mesh.boundary[v]];
            }
            opened.surface.facets.push_back(facet);
            opened.surface.patch.push_back(boundary_.patch()[f]);
        }
    }
    return opened;
}

/// Adds what an operation adds; returns its change of the side, with columns.
template<int D>
BoundaryChange<D> AdaptedBoundary<D>::add(const Cavity<D>& cavity, Index new_column, Opened& opened) const {
    Index new_vertex = no_index;
    if (cavity.has_new_vertex) {
        const Index a = opened.before[cavity.edge[0]];
        const Index b = opened.before[cavity.edge[1]];
        new_vertex =
            opened.add(new_column, provisional_track(new_column), 0.5 * (spacing_[a] + spacing_[b]),
                       times(0.5, plus(boundary_.start()[a], boundary_.start()[b])), cavity.new_place);
    }
    BoundaryChange<D> change = cavity.side;
    for (Facet<D>& facet : change.added) {
        Facet<D> own;
        for (std::size_t k = 0; k < D; ++k) {
            own[k] = facet[k] == Cavity<D>::new_vertex ? new_vertex : opened.number[facet[k]];
            facet[k] = opened.columns[own[k]];
        }
        opened.surface.facets.push_back(own);
        opened.surface.patch.push_back(change.patch);
    }
    return change;
}

template<int D>
void AdaptedBoundary<D>::change(std::size_t layer, std::span<const Cavity<D>> cavities,
                                const AdaptMesh<D>& mesh, Index next_column) {
    SideLayer<D>& side = sweep_.layers.emplace_back(SideLayer<D>{boundary_, columns_, end_, {}});
    const bool changes = std::any_of(cavities.begin(), cavities.end(),
                                     [](const Cavity<D>& cavity) { return cavity.on_boundary(); });
    if (!changes) {
        places_ = end_;
        sweep_.places.push_back(places_);
        return;
    }
    Opened opened = remaining(cavities, mesh);
    for (const Cavity<D>& cavity : cavities) {
        const Index column = next_column;
        next_column += cavity.has_new_vertex ? 1 : 0;
        if (cavity.on_boundary()) {
            side.changes.push_back(add(cavity, column, opened));
        }
    }
    boundary_ = Boundary<D>{std::move(opened.surface), std::move(opened.tracks), opened.spacing}.bounding({});
    columns_ = std::move(opened.columns);
    spacing_.assign(opened.spacing.begin(), opened.spacing.end());
    places_ = std::move(opened.places);
    sweep_.places.push_back(places_);
    changed_ = true;
    require_domain_boundary(boundary_, boundary_.at(places_),
                            {fmt::format("adapted boundary at t = {:.9g}", times_[layer + 1]), {}});
}

template<int D>
std::vector<Index> AdaptedBoundary<D>::vertices_in(const AdaptMesh<D>& mesh) const {
    std::vector<Index> vertices;
    for (const Index column : columns_) {
        const auto found = std::lower_bound(mesh.column.begin(), mesh.column.end(), column);
        vertices.push_back(static_cast<Index>(found - mesh.column.begin()));
    }
    return vertices;
}

template<int D>
std::array<double, 2> AdaptedBoundary<D>::length_ratios() const {
    std::array<double, 2> found{std::numeric_limits<double>::infinity(), 0};
    for (const Facet<D>& facet : boundary_.facets()) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const double length = distance(places_[facet[i]], places_[facet[j]]);
                const double ratio = 2 * length / (spacing_[facet[i]] + spacing_[facet[j]]);
                found = {std::min(found[0], ratio), std::max(found[1], ratio)};
            }
        }
    }
    return found;
}

template<int D>
LayeredSweep<D> AdaptedBoundary<D>::sweep() && {
    sweep_.last = std::move(boundary_);
    sweep_.last_columns = std::move(columns_);
    return std::move(sweep_);
}

template class AdaptedBoundary<2>;
template class AdaptedBoundary<3>;

} // namespace slabhull
