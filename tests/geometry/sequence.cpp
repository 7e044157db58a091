// SPDX-License-Identifier: BSD-3-Clause
// Motions made of others: sequences, and the caller's own functions.
#include "slabhull/geometry/motion.h"
#include "slabhull/geometry/rigid_table.h"
#include "slabhull/geometry/trajectory.h"

#include "geometry/motion_samples.h"
#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

using namespace slabhull;
using tests::corner;
using tests::random_points;
using tests::velocity_at;

namespace {

constexpr double start = 0.5;

/// A growing body, turned by table, about a hinge that turns and drifts.
template<int D>
std::vector<MotionPointer<D>> steps() {
    return {expansion<D>(corner<D>(1, 0, 2), 0.3, start),
            rotation<D>(corner<D>(1, 1, 0), corner<D>(0.2, 0.1, 0.3),
                        AngleTable{{0, 1, 2.5, 3}, {0.5, -1, 2, 1}}),
            rotation<D>(corner<D>(0, 1, 3), corner<D>(-1, 2, 1), 1.2),
            translation<D>(corner<D>(0.3, -0.2, 0.1))};
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a sequence does its steps one after the other, the inner first", "", ((int D), D), 2,
                       3) {
    const auto all = sequence<D>(steps<D>(), start);
    for (Point<D> x : random_points<D>(20, 3)) {
        const Point<D> image = (*all->map(start, 1.8))(x);
        for (const auto& step : steps<D>()) {
            x = (*step->map(start, 1.8))(x);
        }
        CHECK(distance(image, x) < 1e-13);
    }
}

TEST_CASE("a wing that flaps about a hinge which itself turns is where trigonometry has it") {
    const double flap = 0.7;
    const double turn = -0.4;
    const auto wing = sequence<2>({rotation<2>({}, {2, 0}, flap), rotation<2>({}, {0, 0}, turn)}, 0);
    for (const double t : {0.3, 1.7}) { // the tip: hinge at distance 2, wing of length 1
        const Point<2> tip{2 * std::cos(turn * t) + std::cos((turn + flap) * t),
                           2 * std::sin(turn * t) + std::sin((turn + flap) * t)};
        CHECK(distance((*wing->map(0, t))({3, 0}), tip) < 1e-14);
        const Point<2> rate{-2 * turn * std::sin(turn * t) - (turn + flap) * std::sin((turn + flap) * t),
                            2 * turn * std::cos(turn * t) + (turn + flap) * std::cos((turn + flap) * t)};
        CHECK(distance(velocity_at<2>(*wing, tip, t), rate) < 1e-14);
    }
}

TEST_CASE("turns about one axis add up, in a sequence as in one rotation") {
    const Point<3> axis{1, -2, 0.5};
    const Point<3> centre{0.1, 2, 3};
    const auto both = sequence<3>({rotation<3>(axis, centre, 0.8), rotation<3>(axis, centre, 0.5)}, -1);
    const auto once = rotation<3>(axis, centre, 1.3);
    for (const Point<3>& x : random_points<3>(20, 3)) {
        CHECK(distance((*both->map(0.2, 2))(x), (*once->map(0.2, 2))(x)) < 1e-13);
        CHECK(distance(velocity_at<3>(*both, x, 0.7), velocity_at<3>(*once, x, 0.7)) < 1e-13);
    }
}

TEMPLATE_TEST_CASE_SIG("the velocity of a sequence is the derivative of its map", "", ((int D), D), 2, 3) {
    const auto all = sequence<D>(steps<D>(), start);
    const double step = 1e-5;
    for (const Point<D>& x : random_points<D>(20, 3)) {
        const Point<D> later = (*all->map(1.4, 1.4 + step))(x);
        const Point<D> earlier = (*all->map(1.4, 1.4 - step))(x);
        const Point<D> v = velocity_at<D>(*all, x, 1.4);
        for (std::size_t i = 0; i < D; ++i) {
            CHECK(v[i] == Approx((later[i] - earlier[i]) / (2 * step)).margin(1e-8));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("maps of a sequence compose, and go back", "", ((int D), D), 2, 3) {
    const auto all = sequence<D>(steps<D>(), start);
    for (const Point<D>& x : random_points<D>(20, 3)) {
        const Point<D> y = (*all->map(0.2, 0.9))(x);
        CHECK(distance((*all->map(0.9, 2.1))(y), (*all->map(0.2, 2.1))(x)) < 1e-13);
        CHECK(distance((*all->map(0.9, 0.2))(y), x) < 1e-13);
    }
}

TEST_CASE("a sequence within a sequence is the longer sequence") {
    const auto parts = steps<3>();
    const auto flat = sequence<3>(parts, start);
    const auto nested = sequence<3>(
        {sequence<3>({parts[0], parts[1]}, start), sequence<3>({parts[2], parts[3]}, start)}, start);
    for (const Point<3>& x : random_points<3>(20, 3)) {
        CHECK(distance((*nested->map(0.3, 1.9))(x), (*flat->map(0.3, 1.9))(x)) < 1e-13);
        CHECK(distance(velocity_at<3>(*nested, x, 1.1), velocity_at<3>(*flat, x, 1.1)) < 1e-13);
    }
}

TEST_CASE("a velocity formula may be carried by moving frames, and its path turns with them") {
    // dx/dt = (y, 0) in a frame that turns: in the frame, x = x0 + t y0
    const auto sheared = sequence<2>({formula_velocity<2>({"y", "0"}), rotation<2>({}, {}, 0.9)}, 0);
    CHECK_FALSE(sheared->map(0, 1).has_value());
    const std::vector<Point<2>> from = random_points<2>(50, 2);
    std::vector<Point<2>> x = from;
    advance<2>(*sheared, x, 0, 1, {Scheme::rk4, 200});
    const AffineMap<2> turn = *rotation<2>({}, {}, 0.9)->map(0, 1);
    for (std::size_t i = 0; i < x.size(); ++i) {
        CHECK(distance(x[i], turn({from[i][0] + from[i][1], from[i][1]})) < 1e-9);
    }
}

TEST_CASE("rk4 on the velocity of a sequence converges to its map at order 4") {
    const auto wing = sequence<3>(
        {rotation<3>({1, 0, 0}, {0, 1, 0}, 2), rotation<3>({0, 0, 1}, {}, 1.5), translation<3>({1, 0, 0})},
        0);
    std::array<double, 2> errors{};
    for (std::size_t k = 0; k < 2; ++k) {
        const std::vector<Point<3>> from = random_points<3>(50, 2);
        std::vector<Point<3>> x = from;
        advance<3>(*wing, x, 0, 1, {Scheme::rk4, 20 << k});
        for (std::size_t i = 0; i < x.size(); ++i) {
            errors[k] = std::max(errors[k], distance(x[i], (*wing->map(0, 1))(from[i])));
        }
    }
    CHECK(std::log2(errors[0] / errors[1]) == Approx(4).margin(0.2));
}

TEST_CASE("only the first step may lack a closed form, and there must be one") {
    const auto formula = formula_velocity<2>({"y", "x"});
    const auto turning = rotation<2>({}, {}, 1);
    CHECK_THROWS_AS(sequence<2>({}, 0), UsageError);
    CHECK_THROWS_AS(sequence<2>({nullptr}, 0), UsageError);
    CHECK_THROWS_AS(sequence<2>({turning}, std::nan("")), UsageError);
    CHECK_THROWS_WITH(sequence<2>({turning, formula}, 0), Catch::Contains("step 2"));
    CHECK_THROWS_WITH(sequence<2>({turning, sequence<2>({formula, turning}, 0)}, 0),
                      Catch::Contains("step 2"));
    CHECK_NOTHROW(sequence<2>({sequence<2>({formula, turning}, 0), turning}, 0));
}

TEST_CASE("a sequence moves if one of its steps does") {
    CHECK_FALSE(sequence<2>({standing<2>(), standing<2>()}, 0)->moves());
    CHECK(sequence<2>({standing<2>(), rotation<2>({}, {}, 1)}, 0)->moves());
}

TEST_CASE("a function of one point and one of many are the same field as the formula") {
    const auto formula = formula_velocity<2>({"y*cos(t)", "-x*t"});
    const auto one = velocity_field<2>([](const Point<2>& x, double t) {
        return Point<2>{x[1] * std::cos(t), -x[0] * t};
    });
    const auto many = velocity_field<2>([](std::span<const Point<2>> x, double t, std::span<Point<2>> v) {
        for (std::size_t i = 0; i < x.size(); ++i) {
            v[i] = {x[i][1] * std::cos(t), -x[i][0] * t};
        }
    });
    for (const auto& field : {one, many}) {
        std::vector<Point<2>> expected = random_points<2>(3000, 2);
        std::vector<Point<2>> x = expected;
        advance<2>(*formula, expected, 0, 1, {});
        advance<2>(*field, x, 0, 1, {});
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            largest = std::max(largest, distance(x[i], expected[i]));
        }
        CHECK(largest < 1e-14);
        CHECK_FALSE(field->map(0, 1).has_value());
    }
}

TEST_CASE("the schemes have their orders on a caller's function, too") {
    // a swirl whose rate falls with the radius: each point turns by its own angle
    const auto swirl = velocity_field<2>([](const Point<2>& x, double) {
        const double rate = 2 / (1 + x[0] * x[0] + x[1] * x[1]);
        return Point<2>{-rate * x[1], rate * x[0]};
    });
    const auto error = [&swirl](Scheme scheme, int substeps) {
        const std::vector<Point<2>> from = random_points<2>(200, 2);
        std::vector<Point<2>> x = from;
        advance<2>(*swirl, x, 0, 1, {scheme, substeps});
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double angle = 2 / (1 + from[i][0] * from[i][0] + from[i][1] * from[i][1]);
            largest = std::max(largest, distance(x[i], (*rotation<2>({}, {}, angle)->map(0, 1))(from[i])));
        }
        return largest;
    };
    for (const auto& [scheme, order] :
         {std::pair{Scheme::euler, 1.0}, {Scheme::heun, 2.0}, {Scheme::rk4, 4.0}}) {
        CHECK(std::log2(error(scheme, 32) / error(scheme, 64)) == Approx(order).margin(0.1));
    }
}

TEST_CASE("what a caller's function throws comes through, whatever the number of threads") {
    const auto moody = velocity_field<2>([](const Point<2>& x, double) -> Point<2> {
        if (x[0] > 1.9) {
            throw std::domain_error{"out of my depth"};
        }
        return {1, 0};
    });
    for (const int threads : {1, 5}) {
        set_thread_count(threads);
        std::vector<Point<2>> x = random_points<2>(5000, 2);
        CHECK_THROWS_WITH(advance<2>(*moody, x, 0, 1, {}), "out of my depth");
        CHECK_THROWS_AS(advance<2>(*moody, x, 0, 1, {}), std::domain_error);
    }
    set_thread_count(0);
}

TEST_CASE("a caller's function without a finite value, or none at all, is refused") {
    const auto pole = velocity_field<2>([](const Point<2>& x, double) { return Point<2>{1 / x[0], 0}; });
    CHECK_THROWS_WITH(velocity_at<2>(*pole, {0, 3}, 0.5),
                      Catch::Contains("(0, 3)") && Catch::Contains("0.5"));
    CHECK_THROWS_AS(velocity_field<2>(VelocityOfPoint<2>{}), UsageError);
    CHECK_THROWS_AS(velocity_field<3>(VelocityOfPoints<3>{}), UsageError);
}
