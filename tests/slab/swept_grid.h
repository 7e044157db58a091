// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/slab/stitch.h"
#include "slabhull/slab/sweep.h"
#include "specimens.h"

/// Slabs over grids, with caps made by hand: what stitch() takes, without a mesher.
namespace slabhull::specimens {

/// A domain through which a channel runs: its boundary has genus 1.
template<int D>
Grid<D> box_with_channel() {
    return grid<D>(3, [](const std::array<Index, D>& at) { return at[0] != 1 || at[1] != 1; });
}

/// The grid as an initial cap. Tracks run against the numbers of vertices; one patch.
template<int D>
SpatialMesh<D> as_cap(const Grid<D>& grid, IdCounter& ids) {
    SpatialMesh<D> cap;
    cap.points = grid.points;
    cap.cells = grid.cells;
    cap.neighbors = build_adjacency<D>(grid.cells, grid.points.size()).neighbors;
    cap.vertex_ids.resize(cap.points.size());
    std::iota(cap.vertex_ids.begin(), cap.vertex_ids.end(), ids.take(cap.points.size()));
    cap.track_ids.assign(cap.points.size(), no_track);
    for (std::size_t c = 0; c < cap.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            if (cap.neighbors[c][i] == no_index) {
                cap.boundary_facets.push_back(outward_facet<D>(cap.cells[c], static_cast<int>(i)));
            }
        }
    }
    for (const Facet<D>& facet : cap.boundary_facets) {
        for (const Index v : facet) {
            cap.track_ids[v] = static_cast<TrackId>(1 + cap.points.size() - v);
        }
    }
    cap.boundary_patch.assign(cap.boundary_facets.size(), 1);
    cap.patches = {{1, "boundary"}};
    return cap;
}

/// The cap's own cells on its moved boundary: swept vertices first, as a mesher gives them.
template<int D>
CapMesh<D> meshed_alike(const SpatialMesh<D>& cap, const Sweep<D>& sweep) {
    CapMesh<D> mesh;
    std::vector<Index> number(cap.points.size(), no_index);
    mesh.points = sweep.positions.back();
    for (Index v = 0; v < sweep.boundary.vertex_count(); ++v) {
        number[sweep.boundary.mesh_vertices()[v]] = v;
    }
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == no_index) {
            number[v] = static_cast<Index>(mesh.points.size());
            mesh.points.push_back(cap.points[v]);
        }
    }
    mesh.cells = cap.cells;
    for (Simplex<D>& cell : mesh.cells) {
        for (Index& v : cell) {
            v = number[v];
        }
    }
    mesh.neighbors = cap.neighbors;
    return mesh;
}

/// What one slab is stitched from.
template<int D>
struct SlabParts {
    SpatialMesh<D> initial;
    Sweep<D> sweep;
    SpatialMesh<D> terminating;
};

/// One slab of a march: levels `times` on `initial`, whose boundary moves by `motion` (or stands where that
/// is null).
template<int D>
SlabParts<D> next_slab(SpatialMesh<D> initial, std::vector<double> times, const MotionPointer<D>& motion,
                       IdCounter& ids) {
    SlabParts<D> parts;
    PatchMotions<D> motions;
    if (motion != nullptr) {
        motions[1].motion = motion;
    }
    parts.initial = std::move(initial);
    parts.sweep = sweep_boundary<D>(boundary_of(parts.initial), parts.initial, motions, times.front(), times,
                                    TrajectoryOptions{});
    parts.terminating =
        terminating_cap<D>(parts.sweep.boundary, meshed_alike<D>(parts.initial, parts.sweep), ids);
    return parts;
}

/// A slow flow that bends every prism.
template<int D>
MotionPointer<D> bending_flow() {
    if constexpr (D == 2) {
        return formula_velocity<2>({"0.03*y*y-0.1*t", "0.05*x"}, {});
    } else {
        return formula_velocity<3>({"0.03*y*z-0.1*t", "0.05*x", "0.02*x*y"}, {});
    }
}

template<int D>
Hull<D> stitched(const SlabParts<D>& parts, const SideOptions& side) {
    IdCounter ids{1'000'000};
    return stitch<D>(parts.initial, parts.sweep, parts.terminating, side, ids);
}

/// Whether all that a part says is what the whole hull says there.
template<int D>
bool part_is_of(const HullPart<D>& part, const Hull<D>& whole) {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < part.points.size(); ++k) {
        numbers.push_back(part.points_used->member(k));
    }
    bool same = part.hull_cells == whole.cells.size() && part.hull_points() == whole.points.size();
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        same = same && part.points[k] == whole.points[numbers[k]] &&
               part.vertex_ids[k] == whole.vertex_ids[numbers[k]] &&
               part.track_ids[k] == whole.track_ids[numbers[k]];
    }
    for (std::size_t c = 0; c < part.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            same = same && numbers[part.cells[c][i]] == whole.cells[part.range.first + c][i] &&
                   part.in_hull(part.neighbors[c][i]) == whole.neighbors[part.range.first + c][i];
        }
    }
    return same;
}

} // namespace slabhull::specimens
