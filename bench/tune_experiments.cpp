// SPDX-License-Identifier: BSD-3-Clause
// Finds the refinement of each level of an experiment, at which the hull has the paper's numbers of simplices
// and vertices. Usage: tune_experiments <experiment> [<first level> [<most simplices>]]
//
// Most of a hull is its side, which the divisions of the boundary and the layers give exactly, without
// meshing anything. The caps are predicted from the levels before: a polynomial in the refinement. Levels of
// at most so many simplices (20 million) are then meshed, to correct the polynomial and to tell how good it
// was.
#include "slabhull/cases/experiments.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/slab/slab.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

using namespace slabhull;

namespace {

/// Deviations from the paper's counts that the search is content with. Half of what the levels promise.
constexpr double good_enough = 0.015;

struct Counts {
    double cells;
    double vertices;
};

double deviation(const Counts& counts, const HullCounts& paper) {
    return std::max(std::abs(counts.cells / static_cast<double>(paper.cells) - 1),
                    std::abs(counts.vertices / static_cast<double>(paper.vertices) - 1));
}

struct Divisions {
    double body;
    double layers;
};

Divisions divisions_of(const Case& the_case) {
    return {static_cast<double>(std::get<InitialBodies>(the_case.initial).ellipsoids.front().frequency),
            static_cast<double>(the_case.level_times(0).size() - 1)};
}

template<int D>
Counts boundary_of_case(const Case& the_case) {
    const auto& bodies = std::get<InitialBodies>(the_case.initial);
    const auto point = [](const Numbers& numbers) {
        Point<D> at;
        std::copy_n(numbers.begin(), D, at.begin());
        return at;
    };
    const auto& box = std::get<BoxSpec>(bodies.outer);
    const Surface<D> walls = box_surface<D>(point(box.min), point(box.max), box.size, {1, "walls"});
    Counts counts{static_cast<double>(walls.facets.size()), static_cast<double>(walls.points.size())};
    for (const EllipsoidBody& body : bodies.ellipsoids) {
        const double n = body.frequency;
        counts.cells += D == 3 ? 20 * n * n : n;
        counts.vertices += D == 3 ? 10 * n * n + 2 : n;
    }
    return counts;
}

/// The side without the vertices of the caps: every facet's prism has its simplices and, in the splits that
/// the experiments use, a centre of its own and of each of its D quadrilaterals, shared by two.
template<int D>
Counts side_of(const Case& the_case) {
    const Counts boundary = boundary_of_case<D>(the_case);
    const double layers = divisions_of(the_case).layers;
    const double centres = D == 3 ? 1 + 1.5 : 1;
    return {boundary.cells * layers * simplices_per_prism(the_case.split),
            boundary.cells * layers * centres + boundary.vertices * (layers - 1)};
}

template<int D>
Counts mesh_caps(const Case& the_case) {
    IdCounter ids;
    StageClock clock;
    const auto initial = initial_cap<D>(the_case, ids, {}, clock);
    const Boundary<D> boundary = boundary_of(initial);
    const auto settings = settings_of<D>(the_case, boundary);
    const auto sweep = sweep_boundary<D>(boundary, initial, settings.motions, 0, {0, 1}, settings.trajectory);
    const auto terminating = mesh_cap<D>(sweep.at(1), settings.cap);
    return {static_cast<double>(initial.cells.size() + terminating.cells.size()),
            static_cast<double>(initial.points.size() + terminating.points.size())};
}

/// Solves the symmetric system of three equations by Gauss's elimination.
std::array<double, 3> solved(std::array<std::array<double, 4>, 3> rows) {
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double factor = i == k ? 0 : rows[i][k] / rows[k][k];
            for (std::size_t j = 0; j < 4; ++j) {
                rows[i][j] -= factor * rows[k][j];
            }
        }
    }
    return {rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]};
}

/// Numbers of cells and vertices of the caps by refinement r: (a r^2 + b r + c) r^(D - 2), a for the volume,
/// b for the boundary, fitted to what was meshed so far, in relative terms.
class CapCounts {
public:
    explicit CapCounts(int dimension) : dimension_{dimension} {}

    void add(double refinement, const Counts& counts) { seen_.push_back({refinement, counts}); }

    Counts at(double refinement) const {
        const auto of = [&](double Counts::*which) {
            const auto [a, b, c] = fitted(which);
            return ((a * refinement + b) * refinement + c) * std::pow(refinement, dimension_ - 2);
        };
        return {of(&Counts::cells), of(&Counts::vertices)};
    }

private:
    std::array<double, 3> fitted(double Counts::*which) const {
        std::array<std::array<double, 4>, 3> rows{};
        for (const auto& [r, counts] : seen_) {
            const double value = counts.*which;
            const double weight = std::pow(r, dimension_ - 2) / value;
            const std::array<double, 4> row{r * r * weight, r * weight, weight, 1};
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 4; ++j) {
                    rows[i][j] += row[i] * row[j];
                }
            }
        }
        return solved(rows);
    }

    struct Seen {
        double refinement;
        Counts counts;
    };
    int dimension_;
    std::vector<Seen> seen_;
};

template<int D>
class Tuner {
public:
    Tuner(std::string name, double most_cells) : name_{std::move(name)}, most_cells_{most_cells}, caps_{D} {
        for (const double refinement : {0.8, 1.0, 1.4}) {
            caps_.add(refinement, mesh_caps<D>(experiment_at(name_, refinement)));
        }
    }

    void run(std::size_t first_level) {
        const auto levels = experiment_levels(name_);
        for (std::size_t level = 0; level < levels.size(); ++level) {
            const HullCounts& paper = levels[level].paper;
            const double growth =
                static_cast<double>(paper.cells) / static_cast<double>(levels[0].paper.cells);
            scale_ = std::pow(growth, 1.0 / D);
            const double refinement = search(paper);
            if (level + 1 >= first_level) {
                verify(level, refinement, paper);
            }
        }
    }

private:
    Counts predicted(double refinement) const {
        const Counts side = side_of<D>(experiment_at(name_, refinement));
        const Counts caps = caps_.at(refinement);
        return {side.cells + caps.cells, side.vertices + caps.vertices};
    }

    /// The count is a staircase in the refinement, as divisions and layers are whole. Of the steps that are
    /// good enough, the one where those of the body and in time are nearest to proportion with those of level
    /// 1: then errors fall evenly. (Where none is good enough, the nearest.)
    double search(const HullCounts& paper) {
        const double expected = first_ ? *first_ * scale_ : 1;
        const double width = first_ ? 0.15 : 0.5;
        double best = expected;
        double best_cost = 1e300;
        for (double factor = 1 - width; factor < 1 + width; factor += 0.001) {
            const double rounded = std::round(1000 * factor * expected) / 1000;
            const double off = deviation(predicted(rounded), paper);
            const double cost = off < good_enough ? unevenness(rounded) + off : 1 + off;
            if (cost < best_cost) {
                best_cost = cost;
                best = rounded;
            }
        }
        if (!first_) {
            first_ = best;
        }
        return best;
    }

    /// How far body and layers are from what they would be if they need not be whole: at the refinement that
    /// the paper's counts ask for, seen from level 1, and for level 1 at its own.
    double unevenness(double refinement) const {
        constexpr double fine = 100;
        const Divisions unrounded = divisions_of(experiment_at(name_, fine));
        const double ideal = (first_ ? *first_ * scale_ : refinement) / fine;
        const Divisions now = divisions_of(experiment_at(name_, refinement));
        return std::abs(now.body / (unrounded.body * ideal) - 1) +
               std::abs(now.layers / (unrounded.layers * ideal) - 1);
    }

    /// Meshes the caps unless that takes too long; where the prediction was not good enough, searches again
    /// with one that knows better, and takes the best in the end.
    void verify(std::size_t level, double refinement, const HullCounts& paper) {
        if (predicted(refinement).cells > most_cells_) {
            tell(level, refinement, predicted(refinement), paper, "predicted");
            return;
        }
        double best = refinement;
        Counts best_counts{};
        constexpr int most_attempts = 3;
        for (int attempt = 0; attempt < most_attempts && deviation(best_counts, paper) > good_enough;
             ++attempt) {
            const Counts counts = meshed(refinement);
            if (deviation(counts, paper) < deviation(best_counts, paper)) {
                best = refinement;
                best_counts = counts;
            }
            refinement = search(paper);
        }
        tell(level, best, best_counts, paper, "meshed");
    }

    Counts meshed(double refinement) {
        const Case the_case = experiment_at(name_, refinement);
        const Counts side = side_of<D>(the_case);
        const Counts caps = mesh_caps<D>(the_case);
        const Counts counts{side.cells + caps.cells, side.vertices + caps.vertices};
        std::printf("    predicted %.0f cells, %+.2f %%\n", predicted(refinement).cells,
                    100 * (predicted(refinement).cells / counts.cells - 1));
        caps_.add(refinement, caps);
        return counts;
    }

    void tell(std::size_t level, double refinement, const Counts& counts, const HullCounts& paper,
              const char* how) const {
        const Case the_case = experiment_at(name_, refinement);
        const auto [body, layers] = divisions_of(the_case);
        std::printf(
            "%s level %zu refinement %.3f: body %.0f, layers %.0f, %s %.0f cells (%.4f of the paper's), "
            "%.0f vertices (%.4f), caps %.1f %%\n",
            name_.c_str(), level + 1, refinement, body, layers, how, counts.cells,
            counts.cells / static_cast<double>(paper.cells), counts.vertices,
            counts.vertices / static_cast<double>(paper.vertices),
            100 * (1 - side_of<D>(the_case).cells / counts.cells));
        std::fflush(stdout);
    }

    std::string name_;
    double most_cells_;
    CapCounts caps_;
    double scale_ = 1;            ///< wanted refinement over that of level 1
    std::optional<double> first_; ///< refinement of level 1
};

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "Usage: tune_experiments <experiment> [<first level> [<most simplices>]]\n");
        return 2;
    }
    const std::string name = argv[1];
    const auto first = static_cast<std::size_t>(argc > 2 ? std::atoi(argv[2]) : 1);
    const double most_cells = argc > 3 ? std::atof(argv[3]) : 20e6;
    if (experiment_at(name, 1).dimension == 2) {
        Tuner<2>{name, most_cells}.run(first);
    } else {
        Tuner<3>{name, most_cells}.run(first);
    }
    return 0;
}
