// SPDX-License-Identifier: BSD-3-Clause
// A solver's loop on a moving domain: its mesh lies in arrays, its velocity is a function. Three space-time
// slabs are predicted, corrected and accepted; on each, it walks from neighbour to neighbour over the part of
// the hull that the body sweeps. Nothing is written to disk.
#include <slabhull/slabhull.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <vector>

using namespace slabhull;

namespace {

constexpr PatchNumber body = 1;

// --- the mesh: a grid of cubes without the one in its middle, each cube cut into six tetrahedra

constexpr int cubes = 5; // along each axis

DomainInput<3> grid_around_a_body() {
    std::vector<Point<3>> corners;
    std::map<std::array<int, 3>, Index> number_of;
    const auto number = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] = number_of.try_emplace(at, static_cast<Index>(corners.size()));
        if (is_new) {
            corners.push_back({double(at[0]), double(at[1]), double(at[2])});
        }
        return found->second;
    };
    DomainInput<3> input;
    for (int k = 0; k < cubes * cubes * cubes; ++k) {
        const std::array<int, 3> cube{k % cubes, k / cubes % cubes, k / (cubes * cubes)};
        if (cube == std::array<int, 3>{cubes / 2, cubes / 2, cubes / 2}) {
            continue; // the body
        }
        std::array<int, 3> axes{0, 1, 2};
        do { // from the lowest corner to the highest, one axis after the other, in each of the six orders
            std::array<int, 3> at = cube;
            Simplex<3> cell{number(at)};
            for (std::size_t step = 0; step < 3; ++step) {
                ++at[static_cast<std::size_t>(axes[step])];
                cell[step + 1] = number(at);
            }
            const bool even = axes[1] == (axes[0] + 1) % 3;
            if (!even) { // all cells have one orientation
                std::swap(cell[2], cell[3]);
            }
            input.cells.push_back(cell);
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    input.points.assign(corners.begin(), corners.end());
    return input;
}

/// The facets whose corners all lie on the body. The others are left to the patch "boundary".
void add_body_facets(DomainInput<3>& input) {
    const auto on_body = [&input](Index v) {
        return std::all_of(input.points[v].begin(), input.points[v].end(),
                           [](double x) { return x >= cubes / 2 && x <= cubes / 2 + 1; });
    };
    for (const Simplex<3>& cell : input.cells) {
        for (int i = 0; i < 4; ++i) {
            const Facet<3> facet = outward_facet<3>(cell, i);
            if (std::all_of(facet.begin(), facet.end(), on_body)) {
                input.facets.push_back(facet);
                input.facet_patch.push_back(body);
            }
        }
    }
    input.patches = {{body, "body"}};
}

// --- the flow solver's part, which a real one computes

/// The body swings along x; `push` is what the fluid adds to its velocity.
MotionPointer<3> swing(double push) {
    return velocity_field<3>(VelocityOfPoint<3>{[push](const Point<3>&, double t) {
        return Point<3>{0.5 - t + push, 0, 0};
    }});
}

/// The cells over the body, found by walking across facets from one of them; the sum stands for an integral.
double area_swept_by_body(const Hull<3>& hull) {
    std::vector<bool> seen(hull.cells.size(), false);
    std::vector<Index> stack;
    for (std::size_t c = hull.initial_cells; stack.empty() && c < hull.terminating_begin(); ++c) {
        if (hull.patch(c) == body) {
            stack.push_back(static_cast<Index>(c));
            seen[c] = true;
        }
    }
    double area = 0;
    while (!stack.empty()) {
        const Index cell = stack.back();
        stack.pop_back();
        area += norm(simplex_normal<3>(corners_of<3, 4>(hull.cells[cell], hull.points)));
        for (const Index next : hull.neighbors[cell]) {
            if (!seen[next] && hull.patch(next) == body) {
                seen[next] = true;
                stack.push_back(next);
            }
        }
    }
    return area;
}

int run() {
    DomainInput<3> input = grid_around_a_body();
    add_body_facets(input);
    SlabSettings<3> settings;
    settings.motions[body].motion = swing(0);
    March<3> march{march_from<3>(make_domain<3>(std::move(input)), 0.0), std::move(settings)};

    while (march.state().slab < 3) {
        const double t = march.state().time;
        const std::vector<double> levels{t, t + 0.1, t + 0.2};
        const Slab<3> predicted = march.propose(levels);
        march.settings().motions[body].motion = swing(0.02 * area_swept_by_body(predicted.hull));
        Slab<3> corrected = march.propose(levels); // the same ids on the same vertices
        const HullReport report = check_hull<3>(corrected.hull);
        if (!report.clean()) {
            std::cerr << findings_as_text(report);
            return EXIT_FAILURE;
        }
        std::cout << "slab " << corrected.hull.slab << ": " << corrected.hull.cells.size() << " cells, of "
                  << corrected.hull.side_cells << " on the side the body sweeps "
                  << area_swept_by_body(corrected.hull) << '\n';
        march.accept(std::move(corrected));
    }
    return EXIT_SUCCESS;
}

} // namespace

int main() {
    try {
        return run();
    } catch (const std::exception& error) { // an Error carries the entities at fault, too
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
