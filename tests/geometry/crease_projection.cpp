// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/projection.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/motion.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

constexpr double degree = std::numbers::pi / 180;

template<int D>
using Walls = std::vector<ProjectionSurfacePointer<D>>;

template<int D>
std::vector<PlacedSurface<D>> placed(const Walls<D>& walls, const AffineMap<D>& placement = {}) {
    std::vector<PlacedSurface<D>> all;
    for (const auto& wall : walls) {
        all.push_back({wall.get(), placement});
    }
    return all;
}

template<int D>
Point<D> onto_all(const Walls<D>& walls, const Point<D>& x, double extent = 1) {
    std::vector<Point<D>> points{x};
    project_onto_all<D>(placed<D>(walls), points, extent);
    return points[0];
}

template<int D>
Point<D> offset(const Point<D>& x, const Point<D>& by) {
    Point<D> sum;
    for (std::size_t k = 0; k < D; ++k) {
        sum[k] = x[k] + by[k];
    }
    return sum;
}

/// Distance to the farthest of the surfaces.
template<int D>
double gap(const Walls<D>& walls, const Point<D>& x) {
    double largest = 0;
    for (const auto& wall : walls) {
        largest = std::max(largest, distance(wall->closest(x), x));
    }
    return largest;
}

/// A rotation, an expansion and a shift.
AffineMap<3> some_placement() {
    const AffineMap<3> turn = *rotation<3>({1, -2, 0.5}, {1, 2, -3}, 1.1)->map(0, 1);
    const AffineMap<3> grow = *expansion<3>({1, 2, -3}, 1.5, 0)->map(0, 1);
    return compose(compose(turn, grow), *translation<3>({4, 5, 6})->map(0, 1));
}

/// Pairs of surfaces of size 1 with a point of their crease, and the angle at which they cross there.
struct Crease {
    Walls<3> walls;
    Point<3> point;
    double angle;
};

std::vector<Crease> creases() {
    std::vector<Crease> all;
    for (const double angle : {90.0, 60.0, 10.0, 1.0}) {
        const double a = angle * degree;
        const auto floor = plane_surface<3>({0.3, 0.2, 0}, {0, 0, 1});
        all.push_back({{floor, plane_surface<3>({0, -4, 0}, {std::sin(a), 0, std::cos(a)})}, {}, a});
        // A cylinder and a sphere along x, whose centres are so far off the floor that they cross it at the
        // angle.
        const double h = -std::cos(a);
        all.push_back({{floor, cylinder_surface({3, 0, h}, {2, 0, 0}, 1)}, {0, std::sin(a), 0}, a});
        all.push_back({{floor, sphere_surface<3>({0, 0, h}, 1)}, {0, std::sin(a), 0}, a});
        // Two unit spheres: their normals at a common point open by the angle.
        const double c = std::sin(0.5 * a);
        all.push_back({{sphere_surface<3>({c, 0, 0}, 1), sphere_surface<3>({-c, 0, 0}, 1)},
                       {0, 0, std::cos(0.5 * a)},
                       a});
    }
    all.push_back({{ellipsoid_surface<3>({}, {1, 0.5, 0.01}), plane_surface<3>({}, {0, 1, 0})},
                   {1, 0, 0},
                   90 * degree});
    return all;
}

} // namespace

TEST_CASE("a point near a crease ends on both surfaces, not much farther away than it must") {
    for (const Crease& crease : creases()) {
        for (const double reach : {1e-15, 1e-9, 1e-5, 1e-3}) {
            for (const Point<3>& away : random_points<3>(30, reach * std::sin(crease.angle))) {
                const Point<3> x = offset<3>(crease.point, away);
                const Point<3> y = onto_all<3>(crease.walls, x);
                CAPTURE(crease.angle / degree, reach, crease.point, x, y);
                REQUIRE(gap<3>(crease.walls, y) <= 1e-15);
                REQUIRE(distance(x, y) <= 1.3 * distance(x, crease.point) + 1e-15 / std::sin(crease.angle));
            }
        }
    }
}

TEST_CASE("the crease of a cylinder and a plane across it is met at its nearest point") {
    const Walls<3> walls{cylinder_surface({0, 0, 0}, {0, 0, 1}, 2), plane_surface<3>({0, 0, 3}, {0, 0, 1})};
    for (const Point<3>& x : random_points<3>(200, 4)) {
        const double r = std::hypot(x[0], x[1]);
        CHECK(distance(onto_all<3>(walls, x), Point<3>{2 * x[0] / r, 2 * x[1] / r, 3}) < 1e-14);
    }
}

TEST_CASE("far from the origin, creases are met to the rounding of coordinates") {
    for (const double far : {1e2, 1e3, 1e5, 4.321e6}) {
        const Point<3> centre{far / 8, far, 120};
        const Walls<3> walls{cylinder_surface(centre, {0, 0, 1}, 0.6),
                             plane_surface<3>(offset<3>(centre, {0, 0, 0.25}), {0, 0, 1})};
        const double rounding = std::numeric_limits<double>::epsilon() * far;
        for (const Point<3>& away : random_points<3>(100, 0.1)) {
            const Point<3> x = offset<3>(offset<3>(centre, {0.36, 0.48, 0.25}), away);
            const Point<3> y = onto_all<3>(walls, x, 4);
            CAPTURE(far, x, y);
            REQUIRE(gap<3>(walls, y) <= std::max(1e-15, 4 * rounding));
            REQUIRE(distance(x, y) <= 0.2);
        }
    }
}

TEST_CASE("three surfaces meet in a corner, whatever their angles") {
    const Point<3> corner{0.1, 0.2, 0.3};
    const Walls<3> box{plane_surface<3>(corner, {1, 0, 0}), plane_surface<3>(corner, {0, 1, 0}),
                       plane_surface<3>(corner, {0, 0, 1})};
    const Walls<3> sheaf{plane_surface<3>(corner, {1, 0.1, 0}), plane_surface<3>(corner, {1, -0.1, 0}),
                         plane_surface<3>(corner, {1, 0, 0.1})};
    const Walls<3> balls{sphere_surface<3>({1.1, 0.2, 0.3}, 1), sphere_surface<3>({0.1, 1.2, 0.3}, 1),
                         sphere_surface<3>({0.1, 0.2, 1.3}, 1)};
    for (const Walls<3>& walls : {box, sheaf, balls}) {
        for (const Point<3>& away : random_points<3>(100, 0.02)) {
            CHECK(distance(onto_all<3>(walls, offset<3>(corner, away)), corner) < 1e-14);
        }
    }
}

TEST_CASE("curves of the plane meet in points") {
    const Walls<2> lens{sphere_surface<2>({0.5, 0}, 1), sphere_surface<2>({-0.5, 0}, 1)};
    const Walls<2> flat{sphere_surface<2>({0, -std::cos(10 * degree)}, 1), plane_surface<2>({}, {0, 1})};
    for (const Point<2>& away : random_points<2>(100, 0.03)) {
        const Point<2> tip{0, std::sqrt(0.75)};
        CHECK(distance(onto_all<2>(lens, offset<2>(tip, away)), tip) < 1e-15);
        const Point<2> rim{std::sin(10 * degree), 0};
        CHECK(distance(onto_all<2>(flat, offset<2>(rim, away)), rim) < 1e-14);
    }
}

TEST_CASE("surfaces that touch without crossing, as a pipe and its round end, are met where they touch") {
    const Walls<3> capsule{cylinder_surface({0, 0, 0}, {0, 0, 1}, 1), sphere_surface<3>({0, 0, 2}, 1)};
    for (const Point<3>& away : random_points<3>(200, 0.05)) {
        const Point<3> y = onto_all<3>(capsule, offset<3>({0.6, 0.8, 2}, away));
        CHECK(gap<3>(capsule, y) < 1e-13);
        CHECK(std::abs(y[2] - 2) < 1e-6); // as exact as the gap says
    }
}

TEST_CASE("points that are on all surfaces stay, and one surface or the same twice are one surface") {
    for (const Crease& crease : creases()) {
        std::vector<Point<3>> once{offset<3>(crease.point, {1e-3, 2e-3, -1e-3})};
        project_onto_all<3>(placed<3>(crease.walls), once, 1);
        std::vector<Point<3>> twice = once;
        CHECK(project_onto_all<3>(placed<3>(crease.walls), twice, 1).largest < 1e-15);
    }
    const auto egg = ellipsoid_surface<3>({}, {1, 3, 2});
    std::vector<Point<3>> alone = random_points<3>(100, 4);
    std::vector<Point<3>> listed = alone;
    std::vector<Point<3>> doubled = alone;
    project<3>(*egg, some_placement(), alone);
    project_onto_all<3>(placed<3>({egg}, some_placement()), listed, 1);
    CHECK(alone == listed);
    project_onto_all<3>(placed<3>({egg, egg}, some_placement()), doubled, 20);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(distance(alone[i], doubled[i]) < 1e-13);
    }
}

TEST_CASE("surfaces and points that move together meet in the moved place") {
    const AffineMap<3> placement = some_placement();
    for (const Crease& crease : creases()) {
        if (crease.angle < 5 * degree) {
            continue; // there rounding of the placement is magnified
        }
        std::vector<Point<3>> here{offset<3>(crease.point, {1e-3, 2e-3, -1e-3})};
        std::vector<Point<3>> there{placement(here[0])};
        project_onto_all<3>(placed<3>(crease.walls), here, 1);
        project_onto_all<3>(placed<3>(crease.walls, placement), there, 20);
        CHECK(distance(there[0], placement(here[0])) < 1e-12);
    }
}

TEST_CASE("the surfaces of a crease may be placed differently") {
    const auto wall = plane_surface<3>({}, {1, 0, 0});
    const std::vector<PlacedSurface<3>> walls{{wall.get(), {}},
                                              {wall.get(), *rotation<3>({0, 0, 1}, {}, 1.0)->map(0, 0.5)}};
    std::vector<Point<3>> x{{0.1, 0.2, 0.3}};
    std::vector<double> moved(1);
    const ProjectionReport report = project_onto_all<3>(walls, x, 1, moved);
    CHECK(distance(x[0], Point<3>{0, 0, 0.3}) < 1e-15);
    CHECK(moved[0] == Approx(std::hypot(0.1, 0.2)));
    CHECK(report.largest == moved[0]);
    CHECK(report.count == 1);
}

TEST_CASE("surfaces that do not meet are refused with the point, its place and the gap") {
    const Walls<3> parallel{plane_surface<3>({0, 0, 0}, {0, 0, 1}),
                            plane_surface<3>({0, 0, 0.25}, {0, 0, 1})};
    const Walls<3> nested{sphere_surface<3>({}, 1), sphere_surface<3>({}, 1.1)};
    const Walls<3> apart{sphere_surface<3>({}, 1), sphere_surface<3>({3, 0, 0}, 1)};
    const Walls<3> prism{plane_surface<3>({1, 0, 0}, {1, 0, 0}), plane_surface<3>({}, {1, 1, 0}),
                         plane_surface<3>({}, {1, -1, 0})};
    for (const Walls<3>& walls : {parallel, nested, apart, prism}) {
        std::vector<Point<3>> x{{0.5, 0.125, 0}};
        try {
            project_onto_all<3>(placed<3>(walls), x, 1);
            FAIL("accepted at " << x[0][0] << ", " << x[0][1] << ", " << x[0][2]);
        } catch (const GeometryError& error) {
            CHECK_THAT(error.what(), Catch::Contains("point 0 at (0.5, 0.125, 0)"));
            REQUIRE(error.entities.size() == 1);
            CHECK(error.entities[0].number == 0);
        }
    }
    CHECK_THROWS_WITH(onto_all<3>(parallel, {0, 0, 0.1}), Catch::Contains("a distance of 0.125 is left"));
    CHECK_THROWS_AS(onto_all<3>(parallel, {0, std::nan(""), 0}), GeometryError);
}

TEST_CASE("crease points have the same bits for any number of threads") {
    const Crease crease = creases()[2];
    std::vector<Point<3>> one;
    for (const Point<3>& away : random_points<3>(5000, 0.01)) {
        one.push_back(offset<3>(crease.point, away));
    }
    std::vector<Point<3>> many = one;
    set_thread_count(1);
    const ProjectionReport first = project_onto_all<3>(placed<3>(crease.walls), one, 1);
    set_thread_count(5);
    const ProjectionReport second = project_onto_all<3>(placed<3>(crease.walls), many, 1);
    set_thread_count(0);
    CHECK(one == many);
    CHECK(first.mean == second.mean);
}
