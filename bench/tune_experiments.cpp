// SPDX-License-Identifier: BSD-3-Clause
// Finds, for one of the six experiments and the element counts of the paper's table, the refinement of each
// level. Usage: tune_experiments <experiment> <elements of level 1> [<elements of level 2> ...]
#include "slabhull/slab/initial.h"
#include "slabhull/slab/slab.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

using namespace slabhull;

namespace {

constexpr double good_enough = 0.02;

template<int D>
double count_cells(const Case& the_case) {
    IdCounter ids;
    StageClock clock;
    const auto initial = initial_cap<D>(the_case, ids, {}, clock);
    const auto settings = settings_of<D>(the_case, boundary_of(initial));
    const auto sweep = sweep_boundary<D>(initial, settings.motions, 0, {0, 1}, settings.trajectory);
    const auto terminating = mesh_cap<D>(sweep.at(1), settings.cap);
    const std::size_t layers = the_case.level_times(0).size() - 1;
    const auto per_prism = static_cast<std::size_t>(simplices_per_prism(the_case.split));
    const std::size_t side = initial.boundary_facets.size() * layers * per_prism;
    return static_cast<double>(initial.cells.size() + terminating.cells.size() + side);
}

double count_at(const std::string& name, double refinement) {
    const Case the_case = experiment_at(name, refinement);
    return the_case.dimension == 2 ? count_cells<2>(the_case) : count_cells<3>(the_case);
}

/// The count is a staircase in the refinement, as divisions and layers are whole: secant steps first, then a
/// scan around the best for what comes closest.
double tune(const std::string& name, double wanted, double guess) {
    const double power = 1.0 / experiment_at(name, 1).dimension;
    double best = guess;
    double best_error = 1e300;
    const auto attempt = [&](double refinement) {
        const double count = count_at(name, refinement);
        if (std::abs(count / wanted - 1) < best_error) {
            best_error = std::abs(count / wanted - 1);
            best = refinement;
        }
        return count;
    };
    for (int step = 0; step < 4 && best_error > good_enough; ++step) {
        guess *= std::pow(wanted / attempt(guess), power);
    }
    const double centre = best;
    for (int i = 1; i <= 16 && best_error > good_enough; ++i) {
        attempt(centre * (1 + 0.004 * i));
        attempt(centre * (1 - 0.004 * i));
    }
    return best;
}

} // namespace

int main(int argc, char** argv) {
    double guess = 1;
    for (int i = 2; i < argc; ++i) {
        const double wanted = std::atof(argv[i]);
        guess = std::round(1000 * tune(argv[1], wanted, guess)) / 1000;
        const double count = count_at(argv[1], guess);
        std::printf("%s level %d refinement %.3f count %.0f wanted %.0f ratio %.4f layers %zu\n", argv[1],
                    i - 1, guess, count, wanted, count / wanted,
                    experiment_at(argv[1], guess).level_times(0).size() - 1);
        std::fflush(stdout);
        guess *= 1.4;
    }
    return 0;
}
