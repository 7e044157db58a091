// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slab.h"

#include "geometry/meshing/cap_limits.h"
#include "slab/adapt/adapt_cap.h"
#include "slab/march/cap_reuse.h"
#include "slab/stitch/layered_side.h"
#include "slab/sweep/share_levels.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/progress.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/tangling.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <limits>
#include <utility>

namespace slabhull {

namespace {

/// The terminating cap, and, of an adapted one, the column of each vertex.
template<int D>
struct NewCap {
    CapMesh<D> mesh;
    std::vector<Index> column;
    std::size_t columns = 0;               ///< in all
    std::vector<double> spacing;           ///< targets on the boundary
    std::optional<LayeredSweep<D>> side{}; ///< of a boundary whose connectivity was adapted
};

/// Wanted length of edges at each vertex of the boundary.
template<int D>
std::vector<double> boundary_spacing(const Boundary<D>& boundary, const AdaptOptions& options) {
    if (!boundary.spacing().empty()) {
        return {boundary.spacing().begin(), boundary.spacing().end()};
    }
    std::vector<double> spacing = boundary.mean_edges(boundary.start());
    std::vector<double> given(spacing.size(), std::numeric_limits<double>::infinity());
    for (const auto& [patch, wanted] : options.patches) {
        for (const Index v : boundary.vertices_of({patch})) {
            given[v] = std::min(given[v], wanted.size.value_or(given[v]));
        }
    }
    for (std::size_t v = 0; v < spacing.size(); ++v) {
        spacing[v] = std::isfinite(given[v]) ? given[v] : spacing[v];
    }
    return spacing;
}

template<int D>
NewCap<D> make_adapted_cap(CapToStitch<D>& initial, const Sweep<D>& sweep, const SlabSettings<D>& settings,
                           Slab<D>& slab, StageClock& clock) {
    enter_stage("cap adapting");
    require_attainable<D>(sweep.at(0), settings.adapt.size, "adapt.size");
    initial.give_tracks(tracks_throughout(initial.mesh()));
    std::vector<double> spacing = boundary_spacing(sweep.boundary, settings.adapt);
    const BoundaryMotion<D> motion{sweep.boundary, settings.motions, settings.motion_start,
                                   settings.trajectory};
    AdaptedCap<D> adapted = adapt_cap<D>(
        initial.mesh(), initial.tracks(),
        {sweep.boundary.mesh_vertices(), sweep.times, sweep.positions, spacing, &motion}, settings.adapt);
    slab.cap_moved = true;
    slab.adapted.emplace(Adaptation<D>{adapted.report, std::move(adapted.log)});
    clock.book("cap adapting");
    return {std::move(adapted.mesh), std::move(adapted.column), adapted.columns, std::move(spacing),
            std::move(adapted.side)};
}

/// As reuse_cap(), in ranks: by the first, which is given all the cap's cells for that, and all levels if one
/// step does not serve. It keeps the cells of the moved cap.
template<int D>
ReusedCap<D> reuse_in_ranks(CapToStitch<D>& initial, Sweep<D>& sweep, double angle, Communicator& ranks) {
    const std::size_t all = initial.cells().all;
    const HullRange wanted = ranks.first() ? HullRange{0, all} : HullRange{all, 0};
    initial.cells() = redistributed(std::move(initial.cells()), wanted, ranks);
    const auto by_first = [&](const auto& reuse) {
        const typename CapToStitch<D>::WithCells whole{initial};
        return ranks.first() ? reuse(initial.mesh(), sweep, angle) : ReusedCap<D>{};
    };
    ReusedCap<D> reused = together(ranks, [&] { return by_first(reuse_in_one_step<D>); });
    if (ranks.max(reused.good() ? 1 : 0) == 0 && sweep.layers() > 1) {
        reused = together(ranks, [&] {
            const HullRange kept = levels_of_rank(sweep.layers(), ranks);
            share_levels(sweep, ranks.first() ? levels_of({0, sweep.layers()}) : kept, ranks);
            ReusedCap<D> by_levels = by_first(reuse_by_levels<D>);
            keep_levels(sweep, kept);
            return by_levels;
        });
    }
    reused.smallest_angle = ranks.gather(reused.smallest_angle).front();
    reused.mesh = with_shared_points(std::move(reused.mesh), ranks);
    return reused;
}

/// The initial cap moved along, if that is good enough.
template<int D>
std::optional<CapMesh<D>> moved_cap(CapToStitch<D>& initial, Sweep<D>& sweep, const SlabSettings<D>& settings,
                                    Slab<D>& slab, StageClock& clock) {
    enter_stage(cap_meshing_stage);
    ReusedCap<D> reused = settings.ranks != nullptr
                              ? reuse_in_ranks<D>(initial, sweep, settings.reuse_angle, *settings.ranks)
                              : reuse_cap<D>(initial.mesh(), sweep, settings.reuse_angle);
    slab.moved_angle = reused.smallest_angle;
    slab.cap_moved = reused.good();
    clock.book("cap moving");
    return reused.good() ? std::optional{std::move(reused.mesh)} : std::nullopt;
}

template<int D>
CapMesh<D> meshed_cap(const Sweep<D>& sweep, const CapOptions& options, StageClock& clock) {
    return clock.run(cap_meshing_stage,
                     [&] { return mesh_cap<D>(sweep.boundary, sweep.at(sweep.layers()), options); });
}

/// The terminating cap: moved where that is wanted and good enough, else meshed.
template<int D>
CapMesh<D> make_cap(CapToStitch<D>& initial, Sweep<D>& sweep, const SlabSettings<D>& settings, Slab<D>& slab,
                    StageClock& clock) {
    if (settings.reuse == CapReuse::move) {
        if (std::optional<CapMesh<D>> moved = moved_cap<D>(initial, sweep, settings, slab, clock)) {
            return *std::move(moved);
        }
    }
    CapMesh<D> mesh = meshed_cap<D>(sweep, settings.cap, clock);
    slab.cap_blocks = mesh.blocks;
    return mesh;
}

/// A sufficient number of layers if `fit` says that too few were given; empty if none is found.
template<int D>
std::optional<std::size_t> enough_layers(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                                         const std::vector<double>& times, const SlabSettings<D>& settings,
                                         const LayerFit& fit) {
    LayerOptions options = settings.layers;
    options.at_least = static_cast<int>(std::min<std::size_t>(fit.layers + 1, INT_MAX));
    if (options.at_least > options.most) {
        return std::nullopt;
    }
    try {
        return sweep_in_layers<D>(boundary, cap, settings.motions, settings.motion_start,
                                  {times.front(), times.back()}, settings.trajectory, options, settings.ranks)
            .fit.layers;
    } catch (const GeometryError&) {
        return std::nullopt;
    }
}

/// Memory of the hull per simplex of the side.
template<int D>
constexpr double bytes_per_simplex = D == 3 ? 39 : 36;

/// Throws LimitError, with the figures, if the side is too large for indices or memory.
template<int D>
void require_attainable_side(const Boundary<D>& boundary, std::size_t layers, Split split) {
    const double simplices = side_simplex_count(boundary.facets().size(), layers, split);
    const double levels =
        8.0 * D * static_cast<double>(boundary.vertex_count()) * static_cast<double>(layers);
    const double bytes = bytes_per_simplex<D> * simplices + levels;
    const auto free = static_cast<double>(available_memory());
    constexpr auto most_indices = static_cast<double>(no_index);
    if (simplices <= most_indices && bytes <= free) {
        return;
    }
    throw LimitError{fmt::format(
        "a side of {} facets in {} layers, {} simplices each, is {:.3g} simplices and takes {:.3g} GB; "
        "indices count up "
        "to {:.2g}, and {:.3g} GB are free. Fewer layers, more slabs or a coarser boundary would do",
        boundary.facets().size(), layers, simplices_per_prism(split), simplices, 1e-9 * bytes, most_indices,
        1e-9 * free)};
}

/// Step 3 of the method, with layers as they are given or as the motion needs them.
template<int D>
MeasuredSweep<D> sweep_slab(const Boundary<D>& boundary, const SpatialMesh<D>& cap, std::vector<double> times,
                            const SlabSettings<D>& settings, std::optional<std::size_t>& enough) {
    if (settings.layers.automatic && times.size() != 2) {
        throw UsageError{
            fmt::format("layers follow from the motion, so a slab has two times, not {}", times.size())};
    }
    require_attainable_side<D>(boundary, times.size() - 1, settings.side.split);
    MeasuredSweep<D> swept =
        settings.layers.automatic
            ? sweep_in_layers<D>(boundary, cap, settings.motions, settings.motion_start, {times[0], times[1]},
                                 settings.trajectory, settings.layers, settings.ranks)
            : sweep_measured<D>(boundary, cap, settings.motions, settings.motion_start, std::move(times),
                                settings.trajectory, settings.layers, settings.ranks);
    require_attainable_side<D>(boundary, swept.sweep.layers(), settings.side.split);
    enough.reset(); // of an attempt with fewer layers
    if (!swept.fit.sound() && settings.layers.suggest) {
        enough = enough_layers(boundary, cap, swept.sweep.times, settings, swept.fit);
    }
    return swept;
}

/// Puts all vertices of a moved cap on tracks, so that the hull alone tells which vertices correspond.
template<int D>
void track_inside(CapToStitch<D>& initial, const Sweep<D>& sweep, const Slab<D>& slab,
                  SpatialMesh<D>& terminating) {
    if (slab.cap_moved) {
        initial.give_tracks(tracks_throughout(initial.mesh()));
        terminating.track_ids = tracks_moved<D>(initial.tracks(), sweep);
        return;
    }
    for (std::size_t v = 0; v < terminating.track_ids.size(); ++v) {
        TrackId& track = terminating.track_ids[v];
        track = track == no_track ? TrackId{terminating.vertex_ids[v]} : track;
    }
}

/// Gives the vertices made by operations their tracks, and the terminating cap its own.
template<int D>
void track_adapted(const NewCap<D>& cap, IdCounter& ids, AdaptLog<D>& log, SpatialMesh<D>& terminating) {
    give_new_tracks(ids.take(cap.columns - log.tracks.size()), static_cast<Index>(cap.columns), log);
    terminating.track_ids.resize(cap.column.size());
    for (std::size_t v = 0; v < cap.column.size(); ++v) {
        terminating.track_ids[v] = log.tracks[cap.column[v]];
    }
}

template<int D>
MeasuredSweep<D> checked_sweep(const Boundary<D>& boundary, const SpatialMesh<D>& cap,
                               std::vector<double> times, const SlabSettings<D>& settings,
                               std::optional<std::size_t>& enough, StageClock& clock) {
    MeasuredSweep<D> swept = clock.run(
        "trajectories", [&] { return sweep_slab(boundary, cap, std::move(times), settings, enough); });
    clock.run(boundary_check_stage, [&] {
        require_embedded_levels<D>(swept.sweep, settings.motions, settings.motion_start, settings.trajectory,
                                   settings.ranks);
    });
    return swept;
}

constexpr int most_halvings = 6;   ///< of layers, for an adapted cap
constexpr int most_for_angles = 2; ///< the same if only its angles ask for them
constexpr int most_for_sizes = 3;  ///< ... or only the boundary's edges

/// Whether the smallest angle of an adapted cap is about the one aimed at, or no worse than it was.
template<int D>
bool keeps_angles(const SpatialMesh<D>& initial, const Slab<D>& slab, const AdaptOptions& options) {
    const double now = slab.adapted->report.smallest_angle;
    return now >= 0.75 * options.angle ||
           now >= 0.9 * measure_solid<D>(initial.points, initial.cells).angles.smallest;
}

/// Whether the boundary's edges are about as long as they are meant to be, where they are kept to that.
template<int D>
bool keeps_sizes(const Slab<D>& slab, const AdaptOptions& options) {
    constexpr double shortest = 0.6;
    const auto& ratios = slab.adapted->report.boundary_ratios;
    const auto& before = slab.adapted->report.boundary_ratios_before;
    return !ratios || ((*ratios)[0] >= std::min(shortest, (*before)[0]) &&
                       (*ratios)[1] <= std::max(options.longest, (*before)[1]));
}

/// Sweeps the boundary and makes the terminating cap. Layers are halved while cells of an adapted cap would
/// be inside out, its angles have become too small, or the boundary's edges are not kept to their lengths.
template<int D>
std::pair<Sweep<D>, NewCap<D>> sweep_and_cap(CapToStitch<D>& initial, const Boundary<D>& boundary,
                                             std::vector<double> times, SlabSettings<D> settings,
                                             Slab<D>& slab, StageClock& clock) {
    for (int halvings = 0;; ++halvings) {
        auto [sweep, fit] =
            checked_sweep<D>(boundary, initial.mesh(), times, settings, slab.layers_enough, clock);
        slab.layers = fit;
        if (settings.reuse != CapReuse::adapt) {
            NewCap<D> cap{make_cap<D>(initial, sweep, settings, slab, clock), {}, 0, {}};
            return {std::move(sweep), std::move(cap)};
        }
        const std::size_t doubled = 2 * sweep.layers();
        const bool last =
            halvings == most_halvings || doubled > static_cast<std::size_t>(settings.layers.most);
        try {
            NewCap<D> cap = make_adapted_cap<D>(initial, sweep, settings, slab, clock);
            slab.adapted->report.halvings = halvings;
            const bool good_angles =
                halvings >= most_for_angles || keeps_angles<D>(initial.mesh(), slab, settings.adapt);
            const bool good_sizes = halvings >= most_for_sizes || keeps_sizes<D>(slab, settings.adapt);
            if (last || (good_angles && good_sizes)) {
                return {std::move(sweep), std::move(cap)};
            }
        } catch (const InvertedCap&) {
            if (last) {
                throw;
            }
        }
        if (settings.layers.automatic) {
            settings.layers.at_least = static_cast<int>(doubled);
        } else {
            times = halved_levels(times);
        }
    }
}

/// Stitches this rank's part.
template<int D>
void stitch_in_ranks(CapToStitch<D>& initial, Sweep<D>& sweep, SpatialMesh<D>&& terminating,
                     const SlabSettings<D>& settings, IdCounter& side_ids, Slab<D>& slab) {
    CapCells<D> cells = take_cells(terminating, *settings.ranks);
    CapToStitch<D> last{terminating};
    last.give_cells(cells);
    slab.part = stitch_part<D>(std::move(initial), sweep, std::move(last), settings.side, side_ids,
                               *settings.ranks, slab.hull);
    slab.cap = std::move(terminating);
}

/// Stitches a slab whose boundary keeps its connectivity.
template<int D>
void stitch_slab(CapToStitch<D>& initial, Sweep<D>& sweep, NewCap<D>&& cap, const SlabSettings<D>& settings,
                 IdCounter& ids, Slab<D>& slab) {
    IdCounter side_ids{ids.take(side_vertex_count<D>(sweep, settings.side.split))};
    SpatialMesh<D> terminating = terminating_cap<D>(sweep.boundary, std::move(cap.mesh), ids);
    if (settings.reuse == CapReuse::move) {
        track_inside<D>(initial, sweep, slab, terminating);
    }
    if (slab.adapted) {
        track_adapted<D>(cap, ids, slab.adapted->log, terminating);
    }
    if (settings.ranks != nullptr) {
        stitch_in_ranks<D>(initial, sweep, std::move(terminating), settings, side_ids, slab);
    } else {
        slab.hull = stitch<D>(initial, sweep, std::move(terminating), settings.side, side_ids);
    }
    const auto facets = sweep.boundary.facets();
    slab.terminating_facets.assign(facets.begin(), facets.end());
}

/// The boundary with the tracks that its vertices have by now.
template<int D>
Boundary<D> with_tracks(const Boundary<D>& boundary, const SpatialMesh<D>& cap) {
    const auto count = static_cast<std::ptrdiff_t>(boundary.vertex_count());
    const std::span<const double> spacing = boundary.spacing();
    return Boundary<D>{boundary.start_surface(),
                       Array<TrackId>(cap.track_ids.begin(), cap.track_ids.begin() + count),
                       Array<double>(spacing.begin(), spacing.end())};
}

/// Stitches a slab whose boundary changes its connectivity.
template<int D>
void stitch_adapted(CapToStitch<D>& initial, NewCap<D>&& cap, const SlabSettings<D>& settings, IdCounter& ids,
                    Slab<D>& slab) {
    const Boundary<D>& last = cap.side->last;
    LayeredSide<D> side{initial.mesh().points.size(), *cap.side, settings.side};
    IdCounter side_ids{ids.take(side.points())};
    SpatialMesh<D> terminating = terminating_cap<D>(last, std::move(cap.mesh), ids);
    track_adapted<D>(cap, ids, slab.adapted->log, terminating);
    slab.terminating_facets.assign(last.facets().begin(), last.facets().end());
    slab.boundary = with_tracks<D>(last, terminating);
    slab.hull = std::move(side).stitch(initial, std::move(terminating), slab.adapted->log.tracks, side_ids);
}

/// Joins the caps and the side, and fills in what the slab tells of them.
template<int D>
void join_slab(CapToStitch<D>& initial, Sweep<D>&& sweep, NewCap<D>&& cap, int number,
               const SlabSettings<D>& settings, IdCounter ids, Slab<D>& slab) {
    std::vector<double> spacing = std::move(cap.spacing);
    cap.side ? stitch_adapted<D>(initial, std::move(cap), settings, ids, slab)
             : stitch_slab<D>(initial, sweep, std::move(cap), settings, ids, slab);
    if (slab.adapted) {
        slab.hull.adapt_settings = settings_as_numbers(settings.adapt);
        slab.hull.adapt_spacing = std::move(spacing);
    }
    slab.hull.slab = number;
    slab.projected = std::move(sweep.projected);
    slab.next_ids = ids;
}

} // namespace

template<int D>
PreparedSlab<D> sweep_ahead(const Boundary<D>& boundary, const SpatialMesh<D>& cap, std::vector<double> times,
                            const SlabSettings<D>& settings) {
    PreparedSlab<D> prepared;
    auto [sweep, fit] =
        checked_sweep<D>(boundary, cap, std::move(times), settings, prepared.layers_enough, prepared.clock);
    prepared.layers = fit;
    prepared.sweep = std::move(sweep);
    return prepared;
}

template<int D>
void mesh_ahead(PreparedSlab<D>& prepared, const CapOptions& options) {
    prepared.cap = meshed_cap<D>(prepared.sweep, options, prepared.clock);
}

template<int D>
Slab<D> build_slab(CapToStitch<D> initial, const Boundary<D>& boundary, int number, std::vector<double> times,
                   const SlabSettings<D>& settings, IdCounter ids, StageClock& clock) {
    Slab<D> slab;
    auto [sweep, cap] = sweep_and_cap<D>(initial, boundary, times, settings, slab, clock);
    clock.run("stitching",
              [&] { join_slab<D>(initial, std::move(sweep), std::move(cap), number, settings, ids, slab); });
    return slab;
}

template<int D>
Slab<D> build_slab(CapToStitch<D> initial, const Boundary<D>& boundary, int number, PreparedSlab<D> prepared,
                   const SlabSettings<D>& settings, IdCounter ids, StageClock& clock) {
    Slab<D> slab;
    clock.add(prepared.clock);
    slab.layers = prepared.layers;
    slab.layers_enough = prepared.layers_enough;
    slab.cap_blocks = prepared.cap.blocks;
    prepared.sweep.boundary = boundary; // which knows the initial cap
    clock.run("stitching", [&] {
        join_slab<D>(initial, std::move(prepared.sweep), {std::move(prepared.cap), {}, 0, {}}, number,
                     settings, ids, slab);
    });
    return slab;
}

template PreparedSlab<2> sweep_ahead<2>(const Boundary<2>&, const SpatialMesh<2>&, std::vector<double>,
                                        const SlabSettings<2>&);
template void mesh_ahead<2>(PreparedSlab<2>&, const CapOptions&);
template Slab<2> build_slab<2>(CapToStitch<2>, const Boundary<2>&, int, std::vector<double>,
                               const SlabSettings<2>&, IdCounter, StageClock&);
template Slab<2> build_slab<2>(CapToStitch<2>, const Boundary<2>&, int, PreparedSlab<2>,
                               const SlabSettings<2>&, IdCounter, StageClock&);
template PreparedSlab<3> sweep_ahead<3>(const Boundary<3>&, const SpatialMesh<3>&, std::vector<double>,
                                        const SlabSettings<3>&);
template void mesh_ahead<3>(PreparedSlab<3>&, const CapOptions&);
template Slab<3> build_slab<3>(CapToStitch<3>, const Boundary<3>&, int, std::vector<double>,
                               const SlabSettings<3>&, IdCounter, StageClock&);
template Slab<3> build_slab<3>(CapToStitch<3>, const Boundary<3>&, int, PreparedSlab<3>,
                               const SlabSettings<3>&, IdCounter, StageClock&);

} // namespace slabhull
