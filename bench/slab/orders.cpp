// SPDX-License-Identifier: BSD-3-Clause
// Errors and orders of the paper's two turning cases by scheme, substeps and projection: the table of
// docs/trajectories.md, a line of JSON for each movement and measure.
#include "study/order_study.h"

#include <cstdio>

using namespace slabhull;
using namespace slabhull::specimens;

namespace {

constexpr std::array refinements{0.75, 1.0, 1.25, 1.5};

void print(const char* experiment, const Movement& movement, const std::vector<ErrorRow>& rows) {
    for (std::size_t measure = 0; measure < measure_names.size(); ++measure) {
        std::printf(R"({"experiment": "%s", "movement": "%s", "measure": "%s", "order": %.3f)", experiment,
                    movement.name, measure_names[measure], rate(rows, measure, 3));
        const char* separator = R"(, "errors": [)";
        for (const ErrorRow& row : rows) {
            std::printf("%s%.3e", separator, row.errors[measure]);
            separator = ", ";
        }
        std::printf("]}\n");
    }
}

void study(const char* experiment) {
    std::array<std::vector<ErrorRow>, movements.size()> rows;
    for (const double refinement : refinements) {
        const Case planned = proportional_case(experiment, refinement);
        IdCounter ids;
        const SpatialMesh<3> initial = initial_cap_of<3>(planned, ids);
        for (std::size_t m = 0; m < movements.size(); ++m) {
            rows[m].push_back(errors_of<3>(movements[m].applied_to(planned), initial, ids));
        }
        std::fprintf(stderr, "%s, refinement %g: %.0f cells, %g layers\n", experiment, refinement,
                     rows[0].back().cells, static_cast<double>(planned.layers.value_or(0)));
    }
    for (std::size_t m = 0; m < movements.size(); ++m) {
        print(experiment, movements[m], rows[m]);
    }
}

} // namespace

int main() {
    study("ellipsoid");
    study("tandem-ellipsoids");
}
