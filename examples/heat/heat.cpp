// SPDX-License-Identifier: BSD-3-Clause
// Solves the heat equation on a case's moving domain, slab after slab: heat CASE.toml
// The terminating values of one slab are the initial ones of the next.
#include "heat.h"

#include "slabhull/cases/case.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/march.h"

#include <fmt/format.h>

#include <unordered_map>

using namespace slabhull;

namespace {

template<int D>
int run(const Case& the_case, const heat::Problem<D>& problem) {
    StageClock clock;
    IdCounter ids;
    SpatialMesh<D> cap = initial_cap<D>(the_case, ids, {}, clock);
    MarchState<D> state = march_from<D>(std::move(cap), the_case.start, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    settings.reuse = CapReuse::move; // so that slabs can be filled
    settings.reuse_angle = 0;
    March<D> march{std::move(state), std::move(settings)};
    std::unordered_map<PersistentId, double> terminating;
    for (int k = 0; k < the_case.slabs; ++k) {
        Slab<D> slab = march.propose(the_case.level_times(k));
        const Filling<D> filling = fill_slab(slab.hull);
        const std::vector<double> u =
            heat::solve(filling, heat::known_values(filling, problem.solution, terminating), problem.source);
        const heat::Errors error = heat::errors(filling, u, problem);
        fmt::print("slab {}: {} vertices, {} cells, error {:.3e}, of the gradient {:.3e}\n", k,
                   filling.points.size(), filling.cells.size(), std::sqrt(error.value),
                   std::sqrt(error.gradient));
        terminating.clear();
        for (std::size_t v = slab.hull.terminating_points_begin(); v < filling.hull_points; ++v) {
            terminating[filling.vertex_ids[v]] = u[v];
        }
        march.accept(std::move(slab));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: heat CASE.toml [patch]\n");
        return 2;
    }
    const bool patch = argc > 2 && std::string_view{argv[2]} == "patch"; // a solution that is found exactly
    try {
        const Case the_case = read_case(argv[1]);
        return the_case.dimension == 2
                   ? run<2>(the_case, patch ? heat::patch_test<2>() : heat::decaying_wave<2>())
                   : run<3>(the_case, patch ? heat::patch_test<3>() : heat::decaying_wave<3>());
    } catch (const Error& error) {
        fmt::print(stderr, "heat: {}\n", error.what());
        return static_cast<int>(error.failure());
    }
}
