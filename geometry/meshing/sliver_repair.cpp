// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/sliver_repair.h"

#include "core/pieces.h"

#include "geometry/basics/predicates.h"
#include "geometry/basics/vector_algebra.h"
#include "geometry/meshing/grid_directions.h"

#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <vector>

namespace slabhull {

namespace {

constexpr int rounds = 3;
constexpr int steps_per_vertex = 12;
/// Length of steps as a fraction of the mean distance to the neighbours; a search ends below the shortest.
constexpr double first_step = 0.2;
constexpr double last_step = 0.02;

/// Smallest angle of a cell; negative if it is not positively oriented.
double angle(const CapMesh<3>& mesh, Index cell) {
    const auto corners = corners_of<3, 3>(mesh.cells[cell], mesh.points);
    return signed_measure<3>(corners) > 0 ? dihedral_angles<3, 3>(corners).smallest : -1;
}

class SliverRepair {
public:
    SliverRepair(CapMesh<3>& mesh, std::size_t fixed_points, double wanted)
        : mesh_{mesh}, fixed_{fixed_points}, wanted_{wanted} {}

    void run() {
        const std::vector<Index> slivers = find_slivers(mesh_, wanted_);
        for (int round = 0; round < rounds; ++round) {
            for (const Index cell : slivers) {
                repair(cell);
            }
        }
    }

private:
    void repair(Index cell) {
        for (const Index v : mesh_.cells[cell]) {
            if (v >= fixed_ && angle(mesh_, cell) < wanted_) {
                improve(v, cell);
            }
        }
    }

    /// Gathers the cells around a vertex, starting at one of them.
    void gather_star(Index vertex, Index start) {
        star_.assign(1, start);
        for (std::size_t next = 0; next < star_.size(); ++next) {
            const Index cell = star_[next];
            for (std::size_t i = 0; i < 4; ++i) {
                const Index across = mesh_.neighbors[cell][i];
                if (mesh_.cells[cell][i] != vertex && across != no_index &&
                    std::find(star_.begin(), star_.end(), across) == star_.end()) {
                    star_.push_back(across);
                }
            }
        }
    }

    /// Smallest angle around the vertex whose star was gathered; if below `enough`, any value below that.
    double smallest_around(double enough) const {
        double smallest = 180;
        for (const Index cell : star_) {
            smallest = std::min(smallest, angle(mesh_, cell));
            if (smallest < enough) {
                break;
            }
        }
        return smallest;
    }

    double mean_distance(Index vertex) const {
        double sum = 0;
        for (const Index cell : star_) {
            for (const Index v : mesh_.cells[cell]) {
                sum += norm(minus(mesh_.points[v], mesh_.points[vertex]));
            }
        }
        return sum / (3 * static_cast<double>(star_.size()));
    }

    /// Pattern search: takes the best of 26 surrounding places, and shortens the step if none is better.
    void improve(Index vertex, Index cell) {
        gather_star(vertex, cell);
        const double distance = mean_distance(vertex);
        double best = smallest_around(-1);
        double step = first_step;
        for (int k = 0; k < steps_per_vertex && step > last_step && best < wanted_; ++k) {
            if (!move_to_better(vertex, step * distance, best)) {
                step /= 2;
            }
        }
    }

    bool move_to_better(Index vertex, double step, double& best) {
        const Point<3> from = mesh_.points[vertex];
        Point<3> to = from;
        for (const Point<3>& direction : detail::grid_directions()) {
            const double length = direction == Point<3>{} ? 1 : norm(direction);
            mesh_.points[vertex] = plus(from, times(step / length, direction));
            const double smallest = smallest_around(best);
            if (smallest > best && all_positive()) {
                best = smallest;
                to = mesh_.points[vertex];
            }
        }
        mesh_.points[vertex] = to;
        return to != from;
    }

    bool all_positive() const {
        return std::all_of(star_.begin(), star_.end(), [&](Index cell) {
            return exact::orientation(corners_of<3, 3>(mesh_.cells[cell], mesh_.points)) > 0;
        });
    }

    CapMesh<3>& mesh_;
    std::size_t fixed_;
    double wanted_;
    std::vector<Index> star_;
};

} // namespace

std::vector<Index> find_slivers(const CapMesh<3>& mesh, double wanted) {
    constexpr std::size_t grain = 1 << 14;
    return parallel_gather<Index>(mesh.cells.size(), grain,
                                  [&](std::size_t begin, std::size_t end, std::vector<Index>& slivers) {
                                      for (std::size_t cell = begin; cell < end; ++cell) {
                                          if (angle(mesh, static_cast<Index>(cell)) < wanted) {
                                              slivers.push_back(static_cast<Index>(cell));
                                          }
                                      }
                                  });
}

void repair_slivers(CapMesh<3>& mesh, std::size_t fixed_points, double wanted) {
    SliverRepair{mesh, fixed_points, wanted}.run();
}

} // namespace slabhull
