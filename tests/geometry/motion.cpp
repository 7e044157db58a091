// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/motion.h"

#include "geometry/motion_samples.h"
#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace slabhull;
using tests::corner;
using tests::not_a_number;
using tests::random_points;
using tests::velocity_at;

namespace {

using std::numbers::pi;
/// One of each kind that has a closed form.
template<int D>
std::vector<MotionPointer<D>> closed_forms() {
    const Point<D> centre = corner<D>(0.5, -2, 1);
    return {standing<D>(), translation<D>(corner<D>(1, -0.5, 3)), expansion<D>(centre, 0.25, 0.5),
            expansion<D>(centre, -0.2, 0), rotation<D>(corner<D>(1, 2, -2), centre, -1.5)};
}

template<int D>
MotionPointer<D> formula_in_x(const std::string& formula,
                              const std::map<std::string, double>& constants = {}) {
    std::array<std::string, D> formulas;
    formulas.fill("0");
    formulas[0] = formula;
    return formula_velocity<D>(formulas, constants);
}

std::string complaint_about(const std::string& formula, const std::map<std::string, double>& constants = {}) {
    try {
        formula_in_x<2>(formula, constants);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the velocity of a motion is the derivative of its closed form", "", ((int D), D), 2,
                       3) {
    const double step = 1e-4;
    for (const auto& motion : closed_forms<D>()) {
        for (const Point<D>& x : random_points<D>(20, 5)) {
            const Point<D> later = (*motion->map(0.7, 0.7 + step))(x);
            const Point<D> earlier = (*motion->map(0.7, 0.7 - step))(x);
            const Point<D> v = velocity_at<D>(*motion, x, 0.7);
            for (std::size_t i = 0; i < D; ++i) {
                CHECK(v[i] == Approx((later[i] - earlier[i]) / (2 * step)).margin(1e-6));
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("closed forms of consecutive times compose, and backwards they are inverse", "",
                       ((int D), D), 2, 3) {
    for (const auto& motion : closed_forms<D>()) {
        const AffineMap<D> first = *motion->map(0.1, 0.6);
        const AffineMap<D> both = compose<D>(*motion->map(0.6, 1.3), first);
        const AffineMap<D> inverse = inverse_of_similarity<D>(first);
        for (const Point<D>& x : random_points<D>(20, 5)) {
            CHECK(distance(both(x), (*motion->map(0.1, 1.3))(x)) < 1e-14 * 30);
            CHECK(distance((*motion->map(0.6, 0.1))(first(x)), x) < 1e-14 * 30);
            CHECK(distance(inverse(first(x)), x) < 1e-14 * 30);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("a rotation keeps lengths and its centre, and a full turn brings every point back", "",
                       ((int D), D), 2, 3) {
    const Point<D> centre = corner<D>(3, 1, -2);
    const auto turning = rotation<D>(corner<D>(0.3, -1, 2), centre, 0.5);
    const AffineMap<D> part = *turning->map(0, 1.7);
    const AffineMap<D> full = *turning->map(1, 1 + 4 * pi);
    CHECK(distance(part(centre), centre) < 1e-14);
    CHECK(part.scale() == Approx(1).epsilon(1e-14));
    for (const Point<D>& x : random_points<D>(50, 5)) {
        CHECK(distance(part(x), centre) == Approx(distance(x, centre)).epsilon(1e-14));
        CHECK(distance(full(x), x) < 1e-13);
    }
}

TEST_CASE("a positive rate turns counter-clockwise, and right-handed about the axis") {
    const Point<2> plane = (*rotation<2>({}, {1, 0}, pi / 2)->map(0, 1))({2, 0});
    CHECK(distance(plane, Point<2>{1, 1}) < 1e-15);
    const Point<3> space = (*rotation<3>({0, 0, 7}, {1, 0, 5}, pi / 2)->map(0, 1))({2, 0, 0});
    CHECK(distance(space, Point<3>{1, 1, 0}) < 1e-15);
    CHECK(velocity_at<3>(*rotation<3>({3, 0, 0}, {}, 2), {0, 1, 0}, 0) == Point<3>{0, 0, 2});
}

TEST_CASE("a point on the axis of a rotation stays there") {
    const auto turning = rotation<3>({1, 2, -2}, {1, 1, 1}, 5);
    CHECK(distance((*turning->map(0, 0.9))({2, 3, -1}), Point<3>{2, 3, -1}) < 1e-14);
    const Point<3> v = velocity_at<3>(*turning, {2, 3, -1}, 0);
    CHECK(distance(v, Point<3>{}) < 1e-14);
}

TEST_CASE("an expansion scales distances from its centre linearly in time") {
    const auto growing = expansion<2>({1, 1}, 0.25, 2);
    CHECK(growing->map(2, 3)->scale() == Approx(1.25));
    CHECK(distance((*growing->map(2, 4))({2, 1}), Point<2>{2.5, 1}) < 1e-15);
    CHECK(velocity_at<2>(*growing, {2.5, 1}, 4) == Point<2>{0.25, 0});
}

TEST_CASE("an expansion is refused from the time when it has shrunk to a point") {
    const auto shrinking = expansion<2>({}, -0.5, 0);
    CHECK_NOTHROW(shrinking->map(0, 1.99));
    CHECK_THROWS_WITH(shrinking->map(0, 2), Catch::Contains("shrunk to a point at t = 2"));
    CHECK_THROWS_AS(velocity_at<2>(*shrinking, {1, 0}, 2.5), GeometryError);
    CHECK_THROWS_AS(shrinking->map(3, 1), GeometryError);
}

TEST_CASE("only a motion that leaves all points in their places says that it does not move") {
    CHECK_FALSE(standing<3>()->moves());
    CHECK_FALSE(translation<3>({})->moves());
    CHECK_FALSE(rotation<2>({}, {}, 0)->moves());
    CHECK_FALSE(expansion<2>({}, 0, 0)->moves());
    CHECK(translation<3>({0, 0, 1e-300})->moves());
    CHECK(formula_in_x<2>("0")->moves());
}

TEST_CASE("motions refuse arguments that are not finite, and an axis of no direction") {
    CHECK_THROWS_AS(translation<2>({not_a_number, 0}), UsageError);
    CHECK_THROWS_AS(rotation<2>({}, {0, not_a_number}, 1), UsageError);
    CHECK_THROWS_AS(rotation<3>({0, 0, 0}, {}, 1), UsageError);
    CHECK_THROWS_AS(rotation<3>({0, not_a_number, 1}, {}, 1), UsageError);
    CHECK_THROWS_AS(expansion<3>({}, std::numeric_limits<double>::infinity(), 0), UsageError);
    CHECK_NOTHROW(rotation<3>({0, 1e-200, 0}, {}, 1));
}

TEST_CASE("only similarities are inverted") {
    AffineMap<2> map;
    map.rows = {{{1, 0.1}, {0, 1}}};
    CHECK_THROWS_AS(inverse_of_similarity<2>(map), GeometryError);
    map.rows = {{{0, 0}, {0, 0}}};
    CHECK_THROWS_AS(inverse_of_similarity<2>(map), GeometryError);
    map.rows = {{{1, 0}, {0, not_a_number}}};
    CHECK_THROWS_AS(inverse_of_similarity<2>(map), GeometryError);
    map.rows = {{{0, 2}, {2, 0}}}; // a reflection is fine
    CHECK_NOTHROW(inverse_of_similarity<2>(map));
}

TEST_CASE("formulas see the coordinates, the time, pi and the user's constants") {
    const auto motion =
        formula_velocity<3>({"w*x + y*z", "sin(pi*t) - z^2", "(x > 0) ? t : -t"}, {{"w", 2.5}});
    for (const Point<3>& x : random_points<3>(50, 2)) {
        const Point<3> v = velocity_at<3>(*motion, x, 0.3);
        CHECK(v[0] == Approx(2.5 * x[0] + x[1] * x[2]));
        CHECK(v[1] == Approx(std::sin(pi * 0.3) - x[2] * x[2]));
        CHECK(v[2] == (x[0] > 0 ? 0.3 : -0.3));
    }
    CHECK_FALSE(motion->map(0, 1).has_value());
}

TEST_CASE("a formula gives the same values on one thread and on many") {
    const auto motion = formula_velocity<2>({"x*sin(y + t)", "exp(-x*x) - y"});
    const std::vector<Point<2>> x = random_points<2>(20'000, 1);
    std::vector<Point<2>> together(x.size());
    motion->velocity(x, 0.25, together);
    std::vector<Point<2>> apart(x.size());
    set_thread_count(8);
    parallel_for(x.size(), 100, [&](std::size_t begin, std::size_t end) {
        motion->velocity(std::span{x}.subspan(begin, end - begin), 0.25,
                         std::span{apart}.subspan(begin, end - begin));
    });
    set_thread_count(0);
    CHECK(apart == together);
}

TEST_CASE("a formula that is not one plain expression is refused with muParser's words and the place") {
    CHECK_THAT(complaint_about("x + * y"), Catch::Contains("\"x + * y\"") && Catch::Contains("position 4"));
    CHECK_THAT(complaint_about("sin(x"),
               Catch::Contains("Missing parenthesis") && Catch::Contains("position"));
    CHECK_THAT(complaint_about("2*speed"), Catch::Contains("the name \"speed\" means nothing here"));
    CHECK_THAT(complaint_about(""), Catch::Contains("empty"));
    CHECK_THAT(complaint_about("z"), Catch::Contains("\"z\"")); // not a coordinate of the plane
    CHECK_THAT(complaint_about("1,5*x"), Catch::Contains("commas"));
    CHECK_THAT(complaint_about("1 + (x = 3)"), Catch::Contains("=="));
    CHECK_THAT(complaint_about("\"x\""), Catch::Contains("velocity formula"));
    CHECK_THAT(complaint_about(std::string(30'000, '(')), Catch::Contains("velocity formula"));
}

TEST_CASE("a constant of a formula may not take a name that has a meaning, and must have a value") {
    CHECK_THAT(complaint_about("x", {{"t", 1}}), Catch::Contains("\"t\""));
    CHECK_THAT(complaint_about("x", {{"pi", 3}}), Catch::Contains("\"pi\""));
    CHECK_THAT(complaint_about("x", {{"sin", 1}}), Catch::Contains("\"sin\""));
    CHECK_THAT(complaint_about("x", {{"2w", 1}}), Catch::Contains("\"2w\""));
    CHECK_THAT(complaint_about("x", {{"w", not_a_number}}), Catch::Contains("\"w\""));
    CHECK(complaint_about("z", {{"z", 1}}) == "accepted"); // in the plane z is free
}

TEST_CASE("a formula without a finite value names itself, the point and the time") {
    const auto motion = formula_velocity<2>({"y", "1/(x - 1)"});
    CHECK_THROWS_AS(velocity_at<2>(*motion, {1, 0}, 0.5), GeometryError);
    CHECK_THROWS_WITH(velocity_at<2>(*motion, {1, 0}, 0.5), Catch::Contains("\"1/(x - 1)\"") &&
                                                                Catch::Contains("(1, 0)") &&
                                                                Catch::Contains("t = 0.5"));
    CHECK(velocity_at<2>(*motion, {2, 0}, 0.5) == Point<2>{0, 1}); // and is of use afterwards
}
