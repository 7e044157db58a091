// SPDX-License-Identifier: BSD-3-Clause
#include "slab/sweep/boundary_mover.h"

#include "core/place_in_words.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace slabhull {

namespace {

/// Motions that take a vertex to places further apart than this, in extents, disagree.
constexpr double agreement = 1e-9;

constexpr std::size_t most_listed = 8;

void merge(ProjectionReport& into, const ProjectionReport& more) {
    const std::size_t count = into.count + more.count;
    if (count > 0) {
        into.mean =
            (into.mean * static_cast<double>(into.count) + more.mean * static_cast<double>(more.count)) /
            static_cast<double>(count);
    }
    into.largest = std::max(into.largest, more.largest);
    into.count = count;
}

} // namespace

template<int D>
BoundaryMover<D>::BoundaryMover(const Sweep<D>& sweep, const PatchMotions<D>& motions, double motion_start,
                                const TrajectoryOptions& options)
    : sweep_{sweep}, motions_{motions},
      motion_start_{motion_start}, options_{options}, extent_{extent_of<D>(sweep.positions.front())} {
    make_groups();
    make_creases();
}

template<int D>
void BoundaryMover<D>::make_groups() {
    MotionGroup standing;
    MotionGroup stretching;
    for (const Patch& patch : sweep_.boundary.patches()) {
        const auto found = motions_.find(patch.number);
        if (found == motions_.end()) {
            standing.patches.push_back(patch.number);
        } else if (found->second.stretch != nullptr) {
            stretching.patches.push_back(patch.number);
            stretching.moving = &found->second;
        } else {
            groups_.push_back({{patch.number}, &found->second});
        }
    }
    groups_.push_back(std::move(standing));
    groups_.push_back(std::move(stretching));
    for (MotionGroup& group : groups_) {
        group.vertices = sweep_.boundary.vertices_of(group.patches);
    }
}

template<int D>
void BoundaryMover<D>::make_creases() {
    creases_.push_back({}); // of vertices without a surface
    std::vector<std::size_t> crease_at(sweep_.boundary.vertex_count(), 0);
    for (const auto& [patch, moving] : motions_) {
        if (moving.surface == nullptr) {
            continue;
        }
        std::map<std::size_t, std::size_t> with_this; // by old crease: the one with this patch added
        for (const Index v : sweep_.boundary.vertices_of({patch})) {
            const auto [found, fresh] = with_this.try_emplace(crease_at[v], creases_.size());
            if (fresh) {
                creases_.push_back({creases_[crease_at[v]].patches, {}});
                creases_.back().patches.push_back(patch);
            }
            crease_at[v] = found->second;
        }
    }
    for (std::size_t v = 0; v < crease_at.size(); ++v) {
        creases_[crease_at[v]].vertices.push_back(static_cast<Index>(v));
    }
    creases_.front().vertices.clear();
    std::erase_if(creases_, [](const Crease& crease) { return crease.vertices.empty(); });
}

template<int D>
Array<Point<D>> BoundaryMover<D>::move(const Array<Point<D>>& from_places, double from, double to) {
    Array<Point<D>> places = drift(from_places, from, to);
    project(places, to);
    return places;
}

template<int D>
Array<Point<D>> BoundaryMover<D>::drift(const Array<Point<D>>& from_places, double from, double to,
                                        int substeps) {
    for (MotionGroup& group : groups_) {
        advance(group, from_places, from, to, substeps);
    }
    Array<Point<D>> places = joined(from_places, to);
    if (!groups_.back().patches.empty()) {
        groups_.back().moving->stretch->follow(places);
    }
    return places;
}

template<int D>
void BoundaryMover<D>::project(Array<Point<D>>& places, double to) {
    if (!creases_.empty()) {
        const std::vector<double> edges = sweep_.boundary.shortest_edges(places);
        for (const Crease& crease : creases_) {
            project_crease(crease, places, edges, to);
        }
    }
}

template<int D>
void BoundaryMover<D>::advance(MotionGroup& group, const Array<Point<D>>& before, double from, double to,
                               int substeps) const {
    group.places.clear();
    for (const Index v : group.vertices) {
        group.places.push_back(before[v]);
    }
    if (group.moving != nullptr && group.moving->motion != nullptr) {
        TrajectoryOptions options = options_;
        options.substeps = substeps;
        slabhull::advance<D>(*group.moving->motion, group.places, from, to, options);
    } else if (group.moving != nullptr && group.moving->nodal != nullptr) {
        group.moving->nodal->positions(tracks_of<D>(sweep_.boundary, group.vertices), to, group.places);
    }
}

/// Checks that groups take shared vertices to the same place; the first group's is kept. Stretching patches
/// are not compared.
template<int D>
Array<Point<D>> BoundaryMover<D>::joined(const Array<Point<D>>& before, double to) const {
    Array<Point<D>> places = before;
    std::vector<std::int32_t> owner(places.size(), -1);
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
        for (std::size_t i = 0; i < groups_[g].vertices.size(); ++i) {
            const Index v = groups_[g].vertices[i];
            if (owner[v] < 0) {
                owner[v] = static_cast<std::int32_t>(g);
                places[v] = groups_[g].places[i];
            } else if (distance(places[v], groups_[g].places[i]) > agreement * extent_) {
                refuse(groups_[static_cast<std::size_t>(owner[v])], groups_[g], to);
            }
        }
    }
    return places;
}

template<int D>
void BoundaryMover<D>::refuse(const MotionGroup& a, const MotionGroup& b, double to) const {
    std::vector<Entity> apart;
    std::vector<std::string> listed;
    for (std::size_t i = 0, j = 0; i < a.vertices.size() && j < b.vertices.size();) {
        if (a.vertices[i] == b.vertices[j]) {
            if (distance(a.places[i], b.places[j]) > agreement * extent_) {
                apart.push_back(vertex_entity(a.vertices[i], a.patches));
                listed.push_back(fmt::format("{} at {}", apart.back().number,
                                             place_in_words(sweep_.positions.front()[a.vertices[i]])));
            }
            ++i;
            ++j;
        } else {
            a.vertices[i] < b.vertices[j] ? ++i : ++j;
        }
    }
    listed.resize(std::min(listed.size(), most_listed));
    const std::string message = fmt::format(
        "{} and {} share {} vertices that their motions take to different places by t = {}: {}{}. "
        "Give both the same motion there, part them, or let one of them stretch.",
        names(a.patches), names(b.patches), apart.size(), to, fmt::join(listed, ", "),
        apart.size() > most_listed ? " ..." : "");
    throw GeometryError(message, std::move(apart));
}

template<int D>
std::string BoundaryMover<D>::names(const std::vector<PatchNumber>& patches) const {
    std::string text = patches.size() > 1 ? "patches" : "patch";
    for (const PatchNumber number : patches) {
        text += " " + patch_name(sweep_.boundary.patches(), number);
    }
    return text;
}

template<int D>
Entity BoundaryMover<D>::vertex_entity(Index vertex, const std::vector<PatchNumber>& patches) const {
    return {"vertex", sweep_.boundary.mesh_vertices()[vertex],
            patch_name(sweep_.boundary.patches(), patches.front())};
}

template<int D>
void BoundaryMover<D>::project_crease(const Crease& crease, Array<Point<D>>& places,
                                      std::span<const double> room, double to) {
    std::vector<PlacedSurface<D>> surfaces;
    for (const PatchNumber patch : crease.patches) {
        const MovingPatch<D>& moving = motions_.at(patch);
        surfaces.push_back({moving.surface.get(), surface_placement(moving, motion_start_, to)});
    }
    std::vector<Point<D>> projected;
    for (const Index v : crease.vertices) {
        projected.push_back(places[v]);
    }
    std::vector<double> moved(projected.size());
    const ProjectionReport report = project_onto_all<D>(surfaces, projected, extent_, moved);
    require_room(crease, moved, room, places, to);
    for (std::size_t i = 0; i < projected.size(); ++i) {
        places[crease.vertices[i]] = projected[i];
    }
    for (const PatchNumber patch : crease.patches) {
        merge(projected_[patch], report);
    }
}

/// A vertex that projection moves by more than half of its shortest edge may pass its neighbours.
template<int D>
void BoundaryMover<D>::require_room(const Crease& crease, std::span<const double> moved,
                                    std::span<const double> room, const Array<Point<D>>& places,
                                    double to) const {
    std::vector<Entity> too_far;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] > 0.5 * room[crease.vertices[i]]) {
            too_far.push_back(vertex_entity(crease.vertices[i], crease.patches));
            worst = moved[i] > moved[worst] ? i : worst;
        }
    }
    if (!too_far.empty()) {
        const Index v = crease.vertices[worst];
        const std::string message = fmt::format(
            "projection of {} at t = {:.9g} would move {} vertices by more than half of their "
            "shortest edge, the farthest, vertex {} at {}, by {:.4g} with an edge of {:.4g}; "
            "check that the projection surface is that of the patch and that angles of its motion are in "
            "radians, or "
            "shorten the layers",
            names(crease.patches), to, too_far.size(), sweep_.boundary.mesh_vertices()[v],
            place_in_words(places[v]), moved[worst], room[v]);
        throw GeometryError(message, std::move(too_far));
    }
}

template class BoundaryMover<2>;
template class BoundaryMover<3>;

} // namespace slabhull
