// SPDX-License-Identifier: BSD-3-Clause
// A march whose velocity is a std::function, for bench/python_march.py, which does the same from Python:
//   bench_slab_callable_march LEVEL LAYERS SLABS
// Turns the paper's ellipsoid by 0.02 a slab, its cap moved. Prints seconds and CPU seconds for the slabs,
// the cells of the last hull and a checksum of its points, as JSON.
#include "slabhull/cases/case.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/error.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/io/checksum.h"
#include "slabhull/slab/march.h"

#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <utility>
#include <vector>

using namespace slabhull;

namespace {

constexpr double angle = 0.02; // of a slab

MotionPointer<3> turning() {
    return velocity_field<3>(VelocityOfPoint<3>{[](const Point<3>& x, double) {
        return Point<3>{-x[1], x[0], 0};
    }});
}

March<3> march_at(int level) {
    const Case the_case = experiment_case("ellipsoid", level);
    StageClock clock;
    MarchState<3> state = march_from<3>(initial_domain<3>(the_case, {}, {}, clock), 0.0);
    SlabSettings<3> settings = settings_of<3>(the_case, state.boundary);
    settings.reuse = CapReuse::move;
    settings.motions[patch_number(state.cap.patches, "body")] = {turning(), nullptr, nullptr, nullptr};
    return {std::move(state), std::move(settings)};
}

std::vector<double> levels_of(int slab, int layers) {
    std::vector<double> times;
    for (int k = 0; k <= layers; ++k) {
        times.push_back((slab + static_cast<double>(k) / layers) * angle);
    }
    return times;
}

void run(int level, int layers, int slabs) {
    March<3> march = march_at(level);
    std::size_t cells = 0;
    io::Checksum checksum;
    double seconds = 0;
    const double cpu = cpu_seconds();
    for (int k = 0; k < slabs; ++k) {
        const Stopwatch watch;
        Slab<3> slab = march.propose(levels_of(k, layers));
        seconds += watch.seconds();
        if (k + 1 == slabs) {
            cells = slab.hull.cells.size();
            checksum.add(slab.hull.points.data(), slab.hull.points.size() * sizeof(Point<4>));
        }
        const Stopwatch accepting;
        march.accept(std::move(slab));
        seconds += accepting.seconds();
    }
    fmt::print("{{\"seconds\": {}, \"cpu\": {}, \"cells\": {}, \"checksum\": {}}}\n", seconds,
               cpu_seconds() - cpu, cells, checksum.value());
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 4) {
            throw UsageError{"bench_slab_callable_march LEVEL LAYERS SLABS"};
        }
        run(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
        return EXIT_SUCCESS;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return EXIT_FAILURE;
    }
}
