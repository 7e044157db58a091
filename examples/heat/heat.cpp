// SPDX-License-Identifier: BSD-3-Clause
// Solves the heat equation on a case's moving domain, slab after slab, and writes u at some instants.
// The terminating values of one slab are the initial ones of the next.
#include "heat.h"

#include "slabhull/cases/case.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/march.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <unordered_map>

using namespace slabhull;

namespace {

constexpr const char* usage = "usage: heat CASE.toml [wave|patch|warm [FOLDER T1 T2 ..]]\n"
                              "  wave   a decaying wave, the default\n"
                              "  patch  u is linear, which is found exactly\n"
                              "  warm   the first patch is warm, all else cold at first\n"
                              "  FOLDER where u is written at the instants T1, T2 .. after the start\n";

/// u at instants, and where it goes.
struct Output {
    std::filesystem::path folder;
    std::vector<double> times;
};

template<int D>
void write(const Filling<D>& filling, const std::vector<double>& u, const Output& output) {
    const VertexValues solution[]{{"u", u}};
    for (const double time : output.times) {
        if (time > filling.time[0] && time <= filling.time[1]) {
            io::AtomicFile file{output.folder / fmt::format("heat_{}.vtu", time)};
            write_section<D>(file, slice_filling<D>(columns_of(filling), time), solution);
            file.commit();
        }
    }
}

template<int D>
int run(const Case& the_case, const heat::Problem<D>& problem, const Output& output) {
    StageClock clock;
    IdCounter ids;
    SpatialMesh<D> cap = initial_cap<D>(the_case, ids, {}, clock);
    MarchState<D> state = march_from<D>(std::move(cap), the_case.start, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    if (settings.reuse == CapReuse::none) { // then slabs cannot be filled
        settings.reuse = CapReuse::move;
        settings.reuse_angle = 0;
    }
    March<D> march{std::move(state), std::move(settings)};
    std::unordered_map<PersistentId, double> terminating;
    for (int k = 0; k < the_case.slabs; ++k) {
        Slab<D> slab = march.propose(the_case.level_times(k));
        const Filling<D> filling = fill_slab(slab);
        const std::vector<double> u =
            heat::solve(filling, heat::known_values(filling, problem, terminating), problem.source);
        fmt::print("slab {}: {} vertices, {} cells", k, filling.points.size(), filling.cells.size());
        if (problem.gradient) {
            const heat::Errors error = heat::errors(filling, u, problem);
            fmt::print(", error {:.3e}, of the gradient {:.3e}", std::sqrt(error.value),
                       std::sqrt(error.gradient));
        }
        fmt::print("\n");
        write(filling, u, output);
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
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string kind = arguments.size() > 1 ? arguments[1] : "wave";
    if (arguments.empty() || !heat::known_problem<3>(kind)) {
        fmt::print(stderr, "{}", usage);
        return 2;
    }
    try {
        Output output;
        if (arguments.size() > 2) {
            output.folder = arguments[2];
            io::make_folder(output.folder);
        }
        for (std::size_t i = 3; i < arguments.size(); ++i) {
            output.times.push_back(std::stod(arguments[i]));
        }
        const Case the_case = read_case(arguments[0]);
        return the_case.dimension == 2 ? run<2>(the_case, *heat::known_problem<2>(kind), output)
                                       : run<3>(the_case, *heat::known_problem<3>(kind), output);
    } catch (const Error& error) {
        fmt::print(stderr, "heat: {}\n", error.what());
        return static_cast<int>(error.failure());
    } catch (const std::invalid_argument&) { // no number
        fmt::print(stderr, "{}", usage);
        return 2;
    }
}
