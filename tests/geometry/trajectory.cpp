// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/trajectory.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

constexpr std::array stepping_schemes{Scheme::euler, Scheme::heun, Scheme::rk4, Scheme::dopri5};

/// A flow with its solution from time 0.
template<int D>
struct Flow {
    MotionPointer<D> motion;
    Point<D> (*solution)(const Point<D>& x, double t);
};

/// y' = y cos t, and the other components sheared along with y.
Flow<2> shear_in_plane() {
    return {formula_velocity<2>({"y*cos(t)", "y*cos(t)"}), [](const Point<2>& x, double t) {
                const double growth = x[1] * std::expm1(std::sin(t));
                return Point<2>{x[0] + growth, x[1] + growth};
            }};
}

Flow<3> shear_in_space() {
    return {formula_velocity<3>({"y*cos(t)", "y*cos(t)", "-k*y*cos(t)"}, {{"k", 2}}),
            [](const Point<3>& x, double t) {
                const double growth = x[1] * std::expm1(std::sin(t));
                return Point<3>{x[0] + growth, x[1] + growth, x[2] - 2 * growth};
            }};
}

Flow<2> turn_in_plane() {
    return {rotation<2>({}, {1, 0}, 1.5), [](const Point<2>& x, double t) {
                return (*rotation<2>({}, {1, 0}, 1.5)->map(0, t))(x);
            }};
}

Flow<3> turn_in_space() {
    return {rotation<3>({1, 1, 0}, {1, 0, 0}, 1.5), [](const Point<3>& x, double t) {
                return (*rotation<3>({1, 1, 0}, {1, 0, 0}, 1.5)->map(0, t))(x);
            }};
}

template<int D>
double largest_error(const Flow<D>& flow, const TrajectoryOptions& options) {
    const std::vector<Point<D>> start = random_points<D>(1300, 2);
    std::vector<Point<D>> x = start;
    advance<D>(*flow.motion, x, 0, 1, options);
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        largest = std::max(largest, distance(x[i], flow.solution(start[i], 1)));
    }
    return largest;
}

template<int D>
double observed_order(const Flow<D>& flow, Scheme scheme) {
    return std::log2(largest_error(flow, {scheme, 32}) / largest_error(flow, {scheme, 64}));
}

template<int D>
std::string refusal(const Motion<D>& motion, const Point<D>& from, double end,
                    const TrajectoryOptions& options) {
    std::vector<Point<D>> x{from};
    try {
        advance<D>(motion, x, 0, end, options);
    } catch (const GeometryError& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEMPLATE_TEST_CASE_SIG("euler, heun and rk4 have the orders 1, 2 and 4", "", ((int D), D), 2, 3) {
    std::vector<Flow<D>> flows;
    if constexpr (D == 2) {
        flows = {turn_in_plane(), shear_in_plane()};
    } else {
        flows = {turn_in_space(), shear_in_space()};
    }
    for (const Flow<D>& flow : flows) {
        CHECK(observed_order(flow, Scheme::euler) == Approx(1).margin(0.1));
        CHECK(observed_order(flow, Scheme::heun) == Approx(2).margin(0.1));
        CHECK(observed_order(flow, Scheme::rk4) == Approx(4).margin(0.1));
    }
}

TEST_CASE("dopri5 keeps the tolerance it is given, within the growth of the flow") {
    for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
        const TrajectoryOptions options{Scheme::dopri5, 4, tolerance};
        const double extent = 4 * std::sqrt(3.0);
        CHECK(largest_error(turn_in_space(), options) < 10 * tolerance * extent);
        CHECK(largest_error(shear_in_space(), options) < 50 * tolerance * extent);
        CHECK(largest_error(shear_in_plane(), options) > 1e-3 * tolerance); // no better than asked: it adapts
    }
}

TEST_CASE("the substep of dopri5 follows the size of the domain, not its place") {
    const auto turning_here = rotation<2>({}, {0, 0}, 1);
    const auto turning_there = rotation<2>({}, {1024, 0}, 1);
    std::vector<Point<2>> here = random_points<2>(100, 1);
    std::vector<Point<2>> there = here;
    std::for_each(there.begin(), there.end(), [](Point<2>& x) { x[0] += 1024; });
    advance<2>(*turning_here, here, 0, 1, {Scheme::dopri5, 1, 1e-6});
    advance<2>(*turning_there, there, 0, 1, {Scheme::dopri5, 1, 1e-6});
    for (std::size_t i = 0; i < here.size(); ++i) {
        CHECK(distance(there[i], Point<2>{here[i][0] + 1024, here[i][1]}) < 1e-11);
    }
}

TEST_CASE("the closed form is the limit of the steps") {
    for (const auto& motion : {rotation<3>({0, 1, 1}, {1, 0, 0}, 1.5), expansion<3>({1, 2, 3}, 0.25, 0.5),
                               translation<3>({1, -2, 0.5})}) {
        std::vector<Point<3>> exact = random_points<3>(1300, 3);
        std::vector<Point<3>> stepped = exact;
        advance<3>(*motion, exact, 0.5, 2, {Scheme::exact});
        advance<3>(*motion, stepped, 0.5, 2, {Scheme::rk4, 200});
        for (std::size_t i = 0; i < exact.size(); ++i) {
            CHECK(distance(exact[i], stepped[i]) < 1e-8);
        }
    }
}

TEST_CASE("all schemes integrate a constant velocity without error") {
    for (const Scheme scheme : {Scheme::euler, Scheme::heun, Scheme::rk4, Scheme::dopri5, Scheme::exact}) {
        std::vector<Point<2>> x{{1, 2}, {0, 0}};
        advance<2>(*translation<2>({0.5, -1}), x, 1, 3, {scheme, 8});
        CHECK(distance(x[0], Point<2>{2, 0}) < 1e-14);
        CHECK(distance(x[1], Point<2>{1, -2}) < 1e-14);
    }
}

TEST_CASE("points at rest keep every bit, and so does no time at all") {
    const std::vector<Point<3>> start = random_points<3>(100, 3);
    for (const Scheme scheme : {Scheme::euler, Scheme::dopri5, Scheme::exact}) {
        std::vector<Point<3>> x = start;
        advance<3>(*standing<3>(), x, 0, 1, {scheme});
        advance<3>(*rotation<3>({0, 0, 1}, {}, 1), x, 0.5, 0.5, {scheme});
        CHECK(x == start);
    }
    std::vector<Point<3>> nothing;
    CHECK_NOTHROW(advance<3>(*rotation<3>({0, 0, 1}, {}, 1), nothing, 0, 1, {Scheme::dopri5}));
}

TEST_CASE("going back in time returns to the start") {
    const std::vector<Point<2>> start = random_points<2>(100, 2);
    for (const Scheme scheme : {Scheme::rk4, Scheme::dopri5}) {
        std::vector<Point<2>> x = start;
        advance<2>(*shear_in_plane().motion, x, 0, 2, {scheme, 100});
        advance<2>(*shear_in_plane().motion, x, 2, 0, {scheme, 100});
        for (std::size_t i = 0; i < x.size(); ++i) {
            CHECK(distance(x[i], start[i]) < 1e-8);
        }
    }
}

TEST_CASE("dopri5 ends at any time, whatever its last substep rounds to") {
    const auto turning = rotation<2>({}, {}, 1);
    for (const Point<2>& times : random_points<2>(2000, 3)) {
        std::vector<Point<2>> x{{1, 0}};
        advance<2>(*turning, x, times[0], times[1], {Scheme::dopri5, 3, 1e-3});
        CHECK(distance(x[0], (*turning->map(times[0], times[1]))({1, 0})) < 0.1);
    }
}

TEST_CASE("paths have the same bits for any number of threads") {
    const auto motion = formula_velocity<3>({"sin(y*t)", "x*z", "exp(-x*x)"});
    for (const Scheme scheme : stepping_schemes) {
        std::vector<Point<3>> one = random_points<3>(5000, 1);
        std::vector<Point<3>> many = one;
        set_thread_count(1);
        advance<3>(*motion, one, 0, 1, {scheme, 4});
        set_thread_count(7);
        advance<3>(*motion, many, 0, 1, {scheme, 4});
        set_thread_count(0);
        CHECK(one == many);
    }
}

namespace {

/// A shear that counts its calls and the points of each.
struct WholeShear final : Motion<2> {
    explicit WholeShear(bool whole) : whole_{whole} {}
    void velocity(std::span<const Point<2>> x, double, std::span<Point<2>> v) const override {
        sizes.push_back(x.size());
        std::transform(x.begin(), x.end(), v.begin(), [](const Point<2>& p) { return Point<2>{p[1], 0}; });
    }
    std::optional<AffineMap<2>> map(double, double) const override { return std::nullopt; }
    bool in_one_call() const override { return whole_; }

    mutable std::vector<std::size_t> sizes;

private:
    bool whole_;
};

} // namespace

TEST_CASE("a motion may want all points in one call, which changes no bit of the fixed schemes") {
    set_thread_count(1); // the counts are not for several threads
    const auto start = random_points<2>(2000, 5);
    const TrajectoryOptions options{Scheme::rk4, 3, 1e-10};
    auto in_chunks = start;
    advance<2>(WholeShear{false}, in_chunks, 0, 1, options);
    auto at_once = start;
    const auto whole = std::make_shared<WholeShear>(true);
    advance<2>(*whole, at_once, 0, 1, options);
    set_thread_count(0);
    CHECK(at_once == in_chunks);
    CHECK(whole->sizes == std::vector<std::size_t>(4 * 3, start.size()));
    CHECK(sequence<2>({whole, translation<2>({1, 0})}, 0)->in_one_call());
    CHECK_FALSE(sequence<2>({translation<2>({1, 0})}, 0)->in_one_call());
}

TEST_CASE("a path that leaves the finite numbers is refused, never followed forever") {
    const auto blow_up = formula_velocity<2>({"x^2", "0"}); // reaches infinity at t = 1
    for (const Scheme scheme : stepping_schemes) {
        CHECK_THAT(refusal<2>(*blow_up, {1, 0}, 20, {scheme, 40}), !Catch::Equals("accepted"));
    }
    const auto stiff = formula_velocity<2>({"-1e12*(x - t)", "0"});
    CHECK_THAT(refusal<2>(*stiff, {1, 0}, 1, {Scheme::dopri5}), Catch::Contains("dopri5"));
}

TEST_CASE("a point that starts beyond the finite numbers is named") {
    std::vector<Point<2>> x = random_points<2>(2000, 1);
    x[1234][1] = std::numeric_limits<double>::infinity();
    for (const Scheme scheme : {Scheme::rk4, Scheme::exact}) {
        std::vector<Point<2>> copy = x;
        try {
            advance<2>(*rotation<2>({}, {}, 1), copy, 0, 1, {scheme});
            FAIL("accepted");
        } catch (const GeometryError& error) {
            REQUIRE(error.entities.size() == 1);
            CHECK(error.entities[0].number == 1234);
        }
    }
}

TEST_CASE("options that make no sense are refused") {
    std::vector<Point<2>> x{{1, 0}};
    const auto turning = rotation<2>({}, {}, 1);
    CHECK_THROWS_AS(advance<2>(*turning, x, 0, 1, {Scheme::rk4, 0}), UsageError);
    CHECK_THROWS_AS(advance<2>(*turning, x, 0, 1, {Scheme::dopri5, 8, 0.0}), UsageError);
    CHECK_THROWS_AS(advance<2>(*turning, x, 0, std::nan(""), {}), UsageError);
    CHECK_THROWS_WITH(advance<2>(*formula_velocity<2>({"y", "x"}), x, 0, 1, {Scheme::exact}),
                      Catch::Contains("closed form"));
}

TEST_CASE("schemes go by the names of the case file") {
    for (const char* name : {"euler", "heun", "rk4", "dopri5", "exact"}) {
        CHECK(scheme_name(scheme_from_name(name)) == name);
    }
    CHECK_THROWS_AS(scheme_from_name("RK4"), UsageError);
    CHECK_THROWS_WITH(scheme_from_name("rk5"), Catch::Contains("dopri5"));
}
