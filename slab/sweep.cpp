// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sweep.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace slabhull {

namespace {

/// A set of patches whose vertices follow the same motion: one patch, or all those that stand still.
template<int D>
struct MotionGroup {
    std::vector<PatchNumber> patches;
    const MovingPatch<D>* moving = nullptr; ///< null: stands still
    std::vector<Index> vertices;            ///< ascending
    std::vector<Point<D>> positions;        ///< of those vertices
};

template<int D>
double distance(const Point<D>& a, const Point<D>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < D; ++k) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return std::sqrt(sum);
}

template<int D>
double extent(std::span<const Point<D>> points) {
    double largest = 0;
    for (const auto& point : points) {
        largest = std::max(largest, distance<D>(point, points.front()));
    }
    return largest;
}

template<int D>
class Sweeper {
public:
    Sweeper(const PatchMotions<D>& motions, double motion_start, const TrajectoryOptions& options,
            Sweep<D>& sweep)
        : motions_{motions}, motion_start_{motion_start}, options_{options}, sweep_{sweep},
          tolerance_{1e-9 * extent<D>(sweep.surface.points)} {
        make_groups();
    }

    void run() {
        sweep_.positions.push_back(sweep_.surface.points);
        for (std::size_t level = 1; level < sweep_.times.size(); ++level) {
            advance_to(level);
        }
    }

private:
    void make_groups() {
        std::map<PatchNumber, std::size_t> group_of_patch;
        MotionGroup<D> standing;
        for (const Patch& patch : sweep_.surface.patches) {
            const auto found = motions_.find(patch.number);
            if (found == motions_.end()) {
                standing.patches.push_back(patch.number);
            } else {
                group_of_patch[patch.number] = groups_.size();
                groups_.push_back({{patch.number}, &found->second, {}, {}});
            }
        }
        for (const PatchNumber number : standing.patches) {
            group_of_patch[number] = groups_.size();
        }
        groups_.push_back(std::move(standing));
        for (std::size_t f = 0; f < sweep_.surface.facets.size(); ++f) {
            auto& vertices = groups_[group_of_patch.at(sweep_.surface.patch[f])].vertices;
            vertices.insert(vertices.end(), sweep_.surface.facets[f].begin(), sweep_.surface.facets[f].end());
        }
        for (auto& group : groups_) {
            std::sort(group.vertices.begin(), group.vertices.end());
            group.vertices.erase(std::unique(group.vertices.begin(), group.vertices.end()),
                                 group.vertices.end());
        }
    }

    void advance_to(std::size_t level) {
        for (auto& group : groups_) {
            advance_group(group, level);
        }
        join_groups(level);
        for (auto& group : groups_) {
            project_group(group, level);
        }
    }

    void advance_group(MotionGroup<D>& group, std::size_t level) {
        const auto& before = sweep_.positions[level - 1];
        group.positions.clear();
        for (const Index v : group.vertices) {
            group.positions.push_back(before[v]);
        }
        if (group.moving != nullptr) {
            advance<D>(*group.moving->motion, group.positions, sweep_.times[level - 1], sweep_.times[level],
                       options_);
        }
    }

    /// Vertices of several groups must have come to the same place; the first group's position is taken.
    void join_groups(std::size_t level) {
        auto& now = sweep_.positions.emplace_back(sweep_.positions.back());
        std::vector<std::int32_t> owner(now.size(), -1);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            for (std::size_t i = 0; i < groups_[g].vertices.size(); ++i) {
                const Index v = groups_[g].vertices[i];
                if (owner[v] < 0) {
                    owner[v] = static_cast<std::int32_t>(g);
                    now[v] = groups_[g].positions[i];
                } else if (distance<D>(now[v], groups_[g].positions[i]) > tolerance_) {
                    refuse(groups_[static_cast<std::size_t>(owner[v])], groups_[g], level);
                }
            }
        }
    }

    [[noreturn]] void refuse(const MotionGroup<D>& a, const MotionGroup<D>& b, std::size_t level) const {
        std::vector<Entity> apart;
        std::string listed;
        for (std::size_t i = 0, j = 0; i < a.vertices.size() && j < b.vertices.size();) {
            if (a.vertices[i] == b.vertices[j]) {
                if (distance<D>(a.positions[i], b.positions[j]) > tolerance_) {
                    apart.push_back({"vertex", sweep_.cap_vertex[a.vertices[i]], names(a)});
                    if (apart.size() <= 8) {
                        listed +=
                            fmt::format("{}{} at ({:.6g})", apart.size() > 1 ? ", " : "", apart.back().number,
                                        fmt::join(sweep_.positions[0][a.vertices[i]], ", "));
                    }
                }
                ++i;
                ++j;
            } else {
                a.vertices[i] < b.vertices[j] ? ++i : ++j;
            }
        }
        throw GeometryError(
            fmt::format(
                "{} and {} share {} vertices that their motions take to different places by t = {}: {}{}. "
                "Give both the same motion there, or part them.",
                names(a), names(b), apart.size(), sweep_.times[level], listed,
                apart.size() > 8 ? " ..." : ""),
            std::move(apart));
    }

    std::string names(const MotionGroup<D>& group) const {
        std::string text = group.patches.size() > 1 ? "the standing patches" : "patch";
        for (const PatchNumber number : group.patches) {
            text += " " + patch_name(sweep_.surface.patches, number);
        }
        return text;
    }

    void project_group(MotionGroup<D>& group, std::size_t level) {
        if (group.moving == nullptr || group.moving->surface == nullptr) {
            return;
        }
        auto& now = sweep_.positions[level];
        for (std::size_t i = 0; i < group.vertices.size(); ++i) {
            group.positions[i] = now[group.vertices[i]];
        }
        const auto placement = group.moving->motion->map(motion_start_, sweep_.times[level]);
        const ProjectionReport moved = project<D>(*group.moving->surface, placement.value(), group.positions);
        merge(sweep_.projected[group.patches.front()], moved);
        for (std::size_t i = 0; i < group.vertices.size(); ++i) {
            now[group.vertices[i]] = group.positions[i];
        }
    }

    static void merge(ProjectionReport& into, const ProjectionReport& more) {
        const std::size_t count = into.count + more.count;
        if (count > 0) {
            into.mean =
                (into.mean * static_cast<double>(into.count) + more.mean * static_cast<double>(more.count)) /
                static_cast<double>(count);
        }
        into.largest = std::max(into.largest, more.largest);
        into.count = count;
    }

    const PatchMotions<D>& motions_;
    double motion_start_;
    const TrajectoryOptions& options_;
    Sweep<D>& sweep_;
    double tolerance_;
    std::vector<MotionGroup<D>> groups_;
};

} // namespace

template<int D>
Surface<D> Sweep<D>::at(std::size_t level) const {
    Surface<D> result = surface;
    result.points = positions[level];
    return result;
}

template<int D>
Surface<D> boundary_of(const SpatialMesh<D>& cap, Array<Index>& cap_vertex) {
    Surface<D> surface;
    surface.patch = cap.boundary_patch;
    surface.patches = cap.patches;
    std::vector<Index> compact(cap.points.size(), no_index);
    for (const auto& facet : cap.boundary_facets) {
        for (const Index v : facet) {
            compact[v] = 0;
        }
    }
    cap_vertex.clear();
    for (Index v = 0; v < compact.size(); ++v) {
        if (compact[v] == 0) {
            compact[v] = static_cast<Index>(cap_vertex.size());
            cap_vertex.push_back(v);
            surface.points.push_back(cap.points[v]);
        }
    }
    surface.facets = cap.boundary_facets;
    for (auto& facet : surface.facets) {
        for (Index& v : facet) {
            v = compact[v];
        }
    }
    return surface;
}

template<int D>
Sweep<D> sweep_boundary(const SpatialMesh<D>& cap, const PatchMotions<D>& motions, double motion_start,
                        std::vector<double> times, const TrajectoryOptions& options) {
    Sweep<D> sweep;
    sweep.surface = boundary_of(cap, sweep.cap_vertex);
    sweep.times = std::move(times);
    Sweeper<D>{motions, motion_start, options, sweep}.run();
    return sweep;
}

template struct Sweep<2>;
template struct Sweep<3>;
template Surface<2> boundary_of<2>(const SpatialMesh<2>&, Array<Index>&);
template Surface<3> boundary_of<3>(const SpatialMesh<3>&, Array<Index>&);
template Sweep<2> sweep_boundary<2>(const SpatialMesh<2>&, const PatchMotions<2>&, double,
                                    std::vector<double>, const TrajectoryOptions&);
template Sweep<3> sweep_boundary<3>(const SpatialMesh<3>&, const PatchMotions<3>&, double,
                                    std::vector<double>, const TrajectoryOptions&);

} // namespace slabhull
