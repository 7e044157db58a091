// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/projection.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/motion.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

template<int D>
Point<D> first_coordinates(const Point<3>& x) {
    Point<D> kept;
    std::copy_n(x.begin(), D, kept.begin());
    return kept;
}

/// Semi-axes of round, flat, long and thin ellipsoids.
template<int D>
std::vector<Point<D>> shapes() {
    std::vector<Point<D>> shapes;
    for (const Point<3>& axes : {Point<3>{1, 3, 2},
                                 {1, 1, 1},
                                 {2, 1, 1},
                                 {1, 2, 2},
                                 {3, 3, 0.5},
                                 {1, 200, 1},
                                 {1, 1000, 1},
                                 {1000, 1, 1000},
                                 {1e-3, 1, 0.3},
                                 {1, 1 + 1e-9, 1 - 1e-9}}) {
        shapes.push_back(first_coordinates<D>(axes));
    }
    return shapes;
}

/// Random points, and copies of them moved on or very near to planes and axes of symmetry: there the medial
/// axis is.
template<int D>
std::vector<Point<D>> awkward_points(const Point<D>& axes) {
    std::vector<Point<D>> points{Point<D>{}};
    for (const double reach : {0.05, 1.0, 4.0}) {
        for (Point<D> x : random_points<D>(40, reach)) {
            for (std::size_t i = 0; i < D; ++i) {
                x[i] *= axes[i];
            }
            points.push_back(x);
            for (std::size_t i = 0; i < D; ++i) {
                for (const double share : {0.0, 1e-200, 1e-30, 1e-9}) {
                    Point<D> near_plane = x;
                    near_plane[i] *= share;
                    points.push_back(near_plane);
                    Point<D> near_axis = {};
                    near_axis[i] = x[i];
                    near_axis[(i + 1) % D] = x[(i + 1) % D] * share;
                    points.push_back(near_axis);
                }
            }
        }
    }
    return points;
}

/// Points far away, and at the rim of the medial axis, where two closest points become one.
template<int D>
std::vector<Point<D>> far_points_and_rims(const Point<D>& axes) {
    std::vector<Point<D>> points = random_points<D>(40, 1e7 * *std::max_element(axes.begin(), axes.end()));
    const double least = *std::min_element(axes.begin(), axes.end());
    for (std::size_t i = 0; i < D; ++i) {
        const double rim = (axes[i] - least) * (axes[i] + least) / axes[i];
        for (const double share : {1.0, 1 - 1e-15, 1 + 1e-15, 1 - 1e-9, 1 + 1e-9, 0.999, 1.001}) {
            for (const double aside : {0.0, 1e-300, 1e-16, 1e-8}) {
                Point<D> x{};
                x[i] = rim * share;
                x[(i + 1) % D] = least * aside;
                points.push_back(x);
            }
        }
    }
    return points;
}

/// Points that fill the ellipsoid's surface.
template<int D>
std::vector<Point<D>> samples_on(const Point<D>& axes) {
    std::vector<Point<D>> samples = random_points<D>(2000, 1, 99);
    for (Point<D>& x : samples) {
        const double length = distance(x, Point<D>{});
        for (std::size_t i = 0; i < D; ++i) {
            x[i] *= axes[i] / length;
        }
    }
    return samples;
}

/// sum (x_i / e_i)^2 - 1, and the unit normal at x.
template<int D>
double residual(const Point<D>& x, const Point<D>& axes) {
    double sum = -1;
    for (std::size_t i = 0; i < D; ++i) {
        sum += (x[i] / axes[i]) * (x[i] / axes[i]);
    }
    return sum;
}

template<int D>
Point<D> unit_normal(const Point<D>& x, const Point<D>& axes) {
    Point<D> normal;
    for (std::size_t i = 0; i < D; ++i) {
        normal[i] = x[i] / axes[i] / axes[i];
    }
    const double length = distance(normal, Point<D>{});
    std::for_each(normal.begin(), normal.end(), [length](double& entry) { entry /= length; });
    return normal;
}

/// Length of the part of a - b that is not along `direction`.
template<int D>
double sideways(const Point<D>& a, const Point<D>& b, const Point<D>& direction) {
    double along = 0;
    for (std::size_t i = 0; i < D; ++i) {
        along += (a[i] - b[i]) * direction[i];
    }
    Point<D> rest;
    for (std::size_t i = 0; i < D; ++i) {
        rest[i] = a[i] - b[i] - along * direction[i];
    }
    return distance(rest, Point<D>{});
}

/// Where a function of an angle is least: the best of many samples, then narrowed down by thirds.
template<class Function>
long double least_angle(const Function& f) {
    constexpr int samples = 2000;
    constexpr long double spacing = 2 * std::numbers::pi_v<long double> / samples;
    long double best = 0;
    for (int i = 1; i < samples; ++i) {
        best = f(i * spacing) < f(best) ? i * spacing : best;
    }
    long double low = best - spacing;
    long double high = best + spacing;
    for (int step = 0; step < 100; ++step) {
        const long double third = (high - low) / 3;
        f(low + third) < f(high - third) ? high -= third : low += third;
    }
    return low;
}

template<int D>
std::vector<ProjectionSurfacePointer<D>> surfaces() {
    const Point<D> centre = first_coordinates<D>({0.5, -1, 2});
    std::vector<ProjectionSurfacePointer<D>> all{
        sphere_surface<D>(centre, 1.5), ellipsoid_surface<D>(centre, first_coordinates<D>({1, 3, 2})),
        plane_surface<D>(centre, first_coordinates<D>({1, -1, 0.5}))};
    if constexpr (D == 3) {
        all.push_back(cylinder_surface(centre, {1, 2, 3}, 0.7));
    }
    return all;
}

template<int D>
std::vector<AffineMap<D>> placements() {
    const Point<D> centre = first_coordinates<D>({1, 2, -3});
    const AffineMap<D> turn = *rotation<D>(first_coordinates<D>({1, -2, 0.5}), centre, 1.1)->map(0, 1);
    const AffineMap<D> grow = *expansion<D>(centre, 1.5, 0)->map(0, 1);
    const AffineMap<D> shift = *translation<D>(centre)->map(0, 1);
    return {AffineMap<D>{}, turn, grow, shift, compose(compose(turn, grow), shift)};
}

} // namespace

TEMPLATE_TEST_CASE_SIG(
    "the closest point of an ellipsoid lies on it, below the point, and no other is closer", "", ((int D), D),
    2, 3) {
    for (const Point<D>& axes : shapes<D>()) {
        const auto surface = ellipsoid_surface<D>(Point<D>{}, axes);
        const double size = *std::max_element(axes.begin(), axes.end());
        const std::vector<Point<D>> samples = samples_on<D>(axes);
        std::vector<Point<D>> points = awkward_points<D>(axes);
        const std::vector<Point<D>> more = far_points_and_rims<D>(axes);
        points.insert(points.end(), more.begin(), more.end());
        for (const Point<D>& x : points) {
            const Point<D> y = surface->closest(x);
            const double reach = size + distance(x, Point<D>{});
            CAPTURE(axes, x, y);
            REQUIRE(std::abs(residual<D>(y, axes)) < 100 * rounding);
            REQUIRE(sideways<D>(x, y, unit_normal<D>(y, axes)) < 1e-9 * reach);
            const double least = std::transform_reduce(
                samples.begin(), samples.end(), 1e300, [](double a, double b) { return std::min(a, b); },
                [&](const Point<D>& sample) { return distance(sample, x); });
            REQUIRE(distance(x, y) <= least + 1e-13 * reach);
        }
    }
}

TEST_CASE("the closest point of an ellipse is that of brute-force minimisation over its angle") {
    for (const Point<2>& axes : {Point<2>{1, 3}, {1, 1000}, {1000, 1}, {1, 1 + 1e-9}}) {
        const auto surface = ellipsoid_surface<2>(Point<2>{}, axes);
        std::vector<Point<2>> points = awkward_points<2>(axes);
        const std::vector<Point<2>> more = far_points_and_rims<2>(axes);
        points.insert(points.end(), more.begin(), more.end());
        for (const Point<2>& x : points) {
            const auto apart = [&](long double angle) {
                return std::hypot(axes[0] * std::cos(angle) - x[0], axes[1] * std::sin(angle) - x[1]);
            };
            const double least = static_cast<double>(apart(least_angle(apart)));
            const double reach = std::max(axes[0], axes[1]) + distance(x, Point<2>{});
            CAPTURE(axes, x);
            REQUIRE(distance(x, surface->closest(x)) <= least + 4 * rounding * reach);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("points on a surface to rounding hardly move", "", ((int D), D), 2, 3) {
    for (const Point<D>& axes : shapes<D>()) {
        const auto surface = ellipsoid_surface<D>(Point<D>{}, axes);
        const double size = *std::max_element(axes.begin(), axes.end());
        for (const Point<D>& x : samples_on<D>(axes)) {
            REQUIRE(distance(surface->closest(x), x) < 8 * rounding * size);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("projecting twice is projecting once, on every surface and wherever it is placed", "",
                       ((int D), D), 2, 3) {
    for (const auto& surface : surfaces<D>()) {
        for (const AffineMap<D>& placement : placements<D>()) {
            std::vector<Point<D>> once = random_points<D>(200, 5);
            project<D>(*surface, placement, once);
            std::vector<Point<D>> twice = once;
            CHECK(project<D>(*surface, placement, twice).largest < 1e-14 * 20);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("moving points and surface together moves the projection along", "", ((int D), D), 2,
                       3) {
    for (const auto& surface : surfaces<D>()) {
        for (const AffineMap<D>& placement : placements<D>()) {
            std::vector<Point<D>> here = random_points<D>(200, 5);
            std::vector<Point<D>> there(here.size());
            std::transform(here.begin(), here.end(), there.begin(), placement);
            const ProjectionReport at_home = project<D>(*surface, {}, here);
            const ProjectionReport away = project<D>(*surface, placement, there);
            for (std::size_t i = 0; i < here.size(); ++i) {
                CHECK(distance(there[i], placement(here[i])) < 1e-13 * 20);
            }
            CHECK(away.mean == Approx(placement.scale() * at_home.mean));
        }
    }
}

TEST_CASE("sphere, cylinder and plane give the points that elementary geometry gives") {
    CHECK(distance(sphere_surface<2>({1, 0}, 2)->closest({4, 4}), Point<2>{2.2, 1.6}) < 1e-15);
    CHECK(distance(sphere_surface<3>({0, 0, 1}, 5)->closest({0, 0.1, 1}), Point<3>{0, 5, 1}) < 1e-15);
    CHECK(distance(cylinder_surface({1, 0, 0}, {0, 0, 2}, 1)->closest({4, 4, 7}), Point<3>{1.6, 0.8, 7}) <
          1e-15);
    CHECK(distance(plane_surface<3>({0, 0, 2}, {0, 0, -3})->closest({4, 5, 6}), Point<3>{4, 5, 2}) < 1e-15);
    CHECK(distance(plane_surface<2>({1, 1}, {1, 1})->closest({3, 3}), Point<2>{1, 1}) < 1e-15);
}

TEST_CASE("where many points are equally close, one of them is found, the same always") {
    CHECK(sphere_surface<3>({1, 1, 1}, 2)->closest({1, 1, 1}) == Point<3>{3, 1, 1});
    CHECK(ellipsoid_surface<3>({}, {3, 1, 2})->closest({0, 0, 0}) == Point<3>{0, 1, 0});
    CHECK(ellipsoid_surface<3>({}, {2, 2, 2})->closest({-0.0, 0, 0}) == Point<3>{2, 0, 0});
    const Point<3> wall = cylinder_surface({0, 0, 0}, {0, 0, 1}, 2)->closest({0, 0, 5});
    CHECK(wall == Point<3>{2, 0, 5});
}

TEST_CASE("the report says how far the points went") {
    std::vector<Point<2>> x{{3, 0}, {0, 0.5}, {0, -2}};
    std::vector<double> moved(3);
    const ProjectionReport report = project<2>(*sphere_surface<2>({}, 2), {}, x, moved);
    CHECK(x == std::vector<Point<2>>{{2, 0}, {0, 2}, {0, -2}});
    CHECK(moved == std::vector<double>{1, 1.5, 0});
    CHECK(report.largest == 1.5);
    CHECK(report.mean == Approx(2.5 / 3));
    CHECK(report.count == 3);
    CHECK(project<2>(*sphere_surface<2>({}, 2), {}, {}).count == 0);
}

TEST_CASE("projections have the same bits for any number of threads") {
    const auto surface = ellipsoid_surface<3>({0.1, 0, 0}, {1, 3, 2});
    std::vector<Point<3>> one = random_points<3>(30'000, 4);
    std::vector<Point<3>> many = one;
    set_thread_count(1);
    const ProjectionReport first = project<3>(*surface, {}, one);
    set_thread_count(5);
    const ProjectionReport second = project<3>(*surface, {}, many);
    set_thread_count(0);
    CHECK(one == many);
    CHECK(first.mean == second.mean);
}

TEST_CASE("a placement that is no similarity, and a point that is no point, are refused") {
    const auto surface = ellipsoid_surface<2>({}, {1, 2});
    std::vector<Point<2>> x{{1, 1}, {2, std::nan("")}};
    const AffineMap<2> flat{{{{1, 0}, {0, 0}}}, {}};
    CHECK_THROWS_AS(project<2>(*surface, flat, x), GeometryError);
    try {
        project<2>(*surface, {}, x);
        FAIL("accepted");
    } catch (const GeometryError& error) {
        REQUIRE(error.entities.size() == 1);
        CHECK(error.entities[0].number == 1);
    }
}

TEST_CASE("surfaces without extent or direction are refused") {
    CHECK_THROWS_AS(sphere_surface<2>({}, 0), UsageError);
    CHECK_THROWS_AS(sphere_surface<3>({std::nan(""), 0, 0}, 1), UsageError);
    CHECK_THROWS_AS(ellipsoid_surface<3>({}, {1, -1, 1}), UsageError);
    CHECK_THROWS_AS(cylinder_surface({}, {0, 0, 0}, 1), UsageError);
    CHECK_THROWS_AS(cylinder_surface({}, {0, 0, 1}, std::nan("")), UsageError);
    CHECK_THROWS_AS(plane_surface<2>({}, {0, 0}), UsageError);
}
