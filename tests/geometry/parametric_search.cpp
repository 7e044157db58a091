// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/projection/parametric_search.h"

#include "geometry/random_points.h"

#include "slabhull/geometry/projection.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace slabhull;
using detail::ParametricSearch;
using detail::SurfaceJet;
using tests::random_points;

namespace {

using std::numbers::pi;
constexpr double rounding = std::numeric_limits<double>::epsilon();

/// The ellipsoid with semi-axes (1, 3, 2) by longitude and latitude: a seam, and a pole at each end.
SurfaceJet ellipsoid(const ParametricSearch::Parameters& at) {
    const double cu = std::cos(at[0]), su = std::sin(at[0]), cv = std::cos(at[1]), sv = std::sin(at[1]);
    return {{cu * cv, 3 * su * cv, 2 * sv}, {-su * cv, 3 * cu * cv, 0}, {-cu * sv, -3 * su * sv, 2 * cv},
            {-cu * cv, -3 * su * cv, 0},    {su * sv, -3 * cu * sv, 0}, {-cu * cv, -3 * su * cv, -2 * sv}};
}

/// An egg carton over the unit square: many local minima, and a rim.
SurfaceJet carton(const ParametricSearch::Parameters& at) {
    constexpr double w = 10;
    constexpr double h = 0.1;
    const double cu = std::cos(w * at[0]), su = std::sin(w * at[0]);
    const double cv = std::cos(w * at[1]), sv = std::sin(w * at[1]);
    return {{at[0], at[1], h * su * sv},  {1, 0, h * w * cu * sv},     {0, 1, h * w * su * cv},
            {0, 0, -h * w * w * su * sv}, {0, 0, h * w * w * cu * cv}, {0, 0, -h * w * w * su * sv}};
}

Point<3> closest(ParametricSearch& search, const Point<3>& x) {
    Point<3> best{};
    double least = std::numeric_limits<double>::infinity();
    search.visit_feet(x, least, [&](const ParametricSearch::Parameters&, const Point<3>& foot, double d) {
        best = d < least ? foot : best;
        least = std::min(least, d);
        return least;
    });
    return best;
}

} // namespace

TEST_CASE(
    "the search finds the closest point of an ellipsoid to rounding, across its seam and at its poles") {
    ParametricSearch search{ellipsoid, {0, -pi / 2}, {2 * pi, pi / 2}, {24, 24}};
    const auto exact = ellipsoid_surface<3>({}, {1, 3, 2});
    for (const double reach : {0.5, 4.0, 100.0}) {
        for (Point<3> x : random_points<3>(200, reach)) {
            for (const Point<3>& sides : {Point<3>{1, 1, 1}, {1, 1e-9, 1}, {1e-6, 1e-7, 1}, {0, 0, 1}}) {
                const Point<3> moved{x[0] * sides[0], x[1] * sides[1], x[2] * sides[2]};
                const Point<3> y = closest(search, moved);
                const Point<3> wanted = exact->closest(moved);
                CAPTURE(moved, y, wanted);
                CHECK(distance(moved, y) <= distance(moved, wanted) + 20 * rounding * (3 + reach));
                CHECK(distance(y, exact->closest(y)) < 20 * rounding);
            }
        }
    }
}

TEST_CASE("the search finds the closest of many local minima, and points on the surface stay") {
    ParametricSearch search{carton, {0, 0}, {1, 1}, {24, 24}};
    constexpr std::size_t fine = 300;
    for (Point<3> x : random_points<3>(300, 1)) {
        x[2] *= 0.3;
        const Point<3> y = closest(search, x);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < fine * fine; ++i) {
            const double u = static_cast<double>(i % fine) / (fine - 1);
            const double v = static_cast<double>(i / fine) / (fine - 1);
            least = std::min(least, distance(carton({u, v}).value, x));
        }
        CHECK(distance(x, y) <= least);
        CHECK(distance(x, y) >= least - 0.01);
        CHECK(distance(closest(search, y), y) < 4 * rounding);
    }
}
