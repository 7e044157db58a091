// SPDX-License-Identifier: BSD-3-Clause
// Builds the first level of the paper's circle through the installed library.
#include <slabhull/cases/case.h>
#include <slabhull/cases/run.h>
#include <slabhull/core/message.h>

#include <iostream>

int main() {
    slabhull::Case circle = slabhull::experiment_case("circle", 1);
    circle.directory = "consumer-out";
    const slabhull::RunResult result = slabhull::run_case(circle, {});
    std::cout << result.cells << " triangles, " << result.points << " points\n";
    return result.cells == 2 * result.points ? 0 : 1; // the double of a square with one hole is a torus
}
