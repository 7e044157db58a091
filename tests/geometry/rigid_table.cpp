// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/rigid_table.h"

#include "geometry/motion_samples.h"
#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/trajectory.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace slabhull;
using tests::random_points;
using tests::velocity_at;

namespace {

using std::numbers::pi;

/// Where a body is in truth: Eigen's rotations are an implementation apart from ours.
struct Place {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
};

using Course = Place (*)(double t);

Eigen::Matrix3d about(int axis, double angle) {
    return Eigen::AngleAxisd{angle, Eigen::Vector3d::Unit(axis)}.toRotationMatrix();
}

Eigen::Vector3d wobble(double t) {
    return {std::sin(2 * t), 0.3 * t - 0.5 * t * t, std::exp(-t)};
}

/// Roll, pitch and yaw, the last by more than a full turn.
std::array<double, 3> angles_at(double t) {
    return {0.4 * std::sin(3 * t), 0.7 * t * t - 0.2, 5 * t + 0.3};
}

Place tumbling(double t) {
    const auto [roll, pitch, yaw] = angles_at(t);
    return {wobble(t), about(0, roll) * about(1, pitch) * about(2, yaw)};
}

const Point<3> pivot{0.5, -1, 2};
const Point<3> no_axis{};

Point<3> placed(const Place& place, const Point<3>& x) {
    const Eigen::Vector3d c{pivot[0], pivot[1], pivot[2]};
    const Eigen::Vector3d y = c + place.shift + place.turn * (Eigen::Vector3d{x[0], x[1], x[2]} - c);
    return {y[0], y[1], y[2]};
}

/// Instants that are not evenly spaced, from 0 to 2.
std::vector<double> instants(int count) {
    std::vector<double> times;
    for (int i = 0; i <= count; ++i) {
        const double s = static_cast<double>(i) / count;
        times.push_back(2 * s + 0.1 * std::sin(2 * pi * s));
    }
    return times;
}

RigidTable<3> by_angles(int count) {
    RigidTable<3> table{instants(count), {}, {}, {}};
    for (const double t : table.times) {
        const Eigen::Vector3d shift = wobble(t);
        table.shifts.push_back({shift[0], shift[1], shift[2]});
        table.angles.push_back(angles_at(t));
    }
    return table;
}

/// The same places; every other quaternion with the other sign.
RigidTable<3> by_quaternions(int count) {
    RigidTable<3> table = by_angles(count);
    table.angles.clear();
    for (std::size_t i = 0; i < table.times.size(); ++i) {
        const Eigen::Quaterniond q{tumbling(table.times[i]).turn};
        const double sign = i % 2 == 0 ? 1 : -1;
        table.quaternions.push_back({sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()});
    }
    return table;
}

RigidTable<2> in_plane(int count) {
    RigidTable<2> table{instants(count), {}, {}, {}};
    for (const double t : table.times) {
        table.shifts.push_back({std::sin(2 * t), 0.3 * t - 0.5 * t * t});
        table.angles.push_back({5 * t + 0.4 * std::sin(3 * t)});
    }
    return table;
}

template<int D>
std::vector<MotionPointer<D>> specimens(int count) {
    if constexpr (D == 2) {
        const RigidTable<2> table = in_plane(count);
        AngleTable angles{table.times, {}};
        for (const auto& row : table.angles) {
            angles.angles.push_back(row[0]);
        }
        return {rigid_table<2>(table, {0.5, -1}), rotation<2>({}, {0.5, -1}, angles)};
    } else {
        RigidTable<3> no_turn = by_angles(count);
        no_turn.angles.clear();
        RigidTable<3> no_shift = by_quaternions(count);
        no_shift.shifts.clear();
        return {rigid_table<3>(by_angles(count), pivot), rigid_table<3>(by_quaternions(count), pivot),
                rigid_table<3>(no_turn, pivot), rigid_table<3>(no_shift, pivot)};
    }
}

/// Where the motion takes points that were placed at time 0, against where they are in truth.
double largest_error(const Motion<3>& motion, double t) {
    double largest = 0;
    const AffineMap<3> map = *motion.map(0, t);
    for (const Point<3>& x : random_points<3>(20, 2)) {
        largest = std::max(largest, distance(map(placed(tumbling(0), x)), placed(tumbling(t), x)));
    }
    return largest;
}

double largest_error(const Motion<3>& motion) {
    double largest = 0;
    for (int i = 0; i <= 200; ++i) {
        largest = std::max(largest, largest_error(motion, 0.01 * i));
    }
    return largest;
}

template<int D>
std::string refusal(const RigidTable<D>& table) {
    try {
        rigid_table<D>(table, {});
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("a rigid table is exact at its rows") {
    for (const auto& table : {by_angles(12), by_quaternions(12)}) {
        const auto motion = rigid_table<3>(table, pivot);
        for (const double t : table.times) {
            CHECK(largest_error(*motion, t) < 1e-14);
        }
    }
}

TEST_CASE("between the rows angles and quaternions alike have order 4") {
    for (const auto& table : {by_angles, by_quaternions}) {
        const double coarse = largest_error(*rigid_table<3>(table(40), pivot));
        const double fine = largest_error(*rigid_table<3>(table(80), pivot));
        CAPTURE(coarse, fine);
        CHECK(std::log2(coarse / fine) == Approx(4).margin(0.35));
        CHECK(fine < 1e-4);
    }
}

TEMPLATE_TEST_CASE_SIG("the velocity of a table is the derivative of its map, at rows and between", "",
                       ((int D), D), 2, 3) {
    const double step = 1e-5;
    for (const auto& motion : specimens<D>(7)) {
        for (const double t : {0.1, instants(7)[3], 1.0, 1.93}) {
            for (const Point<D>& x : random_points<D>(10, 3)) {
                const Point<D> later = (*motion->map(t, t + step))(x);
                const Point<D> earlier = (*motion->map(t, t - step))(x);
                const Point<D> v = velocity_at<D>(*motion, x, t);
                for (std::size_t i = 0; i < D; ++i) {
                    CHECK(v[i] == Approx((later[i] - earlier[i]) / (2 * step)).margin(1e-7));
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("velocity and acceleration of a table do not jump at its rows", "", ((int D), D), 2,
                       3) {
    const double step = 1e-6;
    for (const auto& motion : specimens<D>(7)) {
        for (std::size_t row = 1; row < 7; ++row) {
            const double t = instants(7)[row];
            for (const Point<D>& x : random_points<D>(5, 3)) {
                std::array<Point<D>, 4> v; // of the same body point, before and after the row
                for (int k = 0; k < 4; ++k) {
                    const double at = t + (k - 1.5) * step;
                    v[static_cast<std::size_t>(k)] = velocity_at<D>(*motion, (*motion->map(t, at))(x), at);
                }
                for (std::size_t i = 0; i < D; ++i) {
                    CHECK(v[2][i] - v[1][i] == Approx(0).margin(1e-3));
                    const double before = (v[1][i] - v[0][i]) / step;
                    const double after = (v[3][i] - v[2][i]) / step;
                    CHECK(before == Approx(after).margin(1e-2));
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE_SIG("maps of a table compose, go back, and keep lengths", "", ((int D), D), 2, 3) {
    for (const auto& motion : specimens<D>(9)) {
        const AffineMap<D> both = compose<D>(*motion->map(0.8, 1.7), *motion->map(0.2, 0.8));
        const AffineMap<D> forth = *motion->map(0.2, 1.7);
        for (const Point<D>& x : random_points<D>(20, 5)) {
            CHECK(distance(both(x), forth(x)) < 1e-13);
            CHECK(distance((*motion->map(1.7, 0.2))(forth(x)), x) < 1e-13);
            CHECK(distance(forth(x), forth({})) == Approx(distance(x, Point<D>{})).epsilon(1e-13));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("rk4 on the velocity of a table converges to its map at order 4", "", ((int D), D), 2,
                       3) {
    for (const auto& motion : specimens<D>(2)) { // two pieces make one parabola: no kinks of the derivatives
        std::array<double, 2> errors{};
        for (std::size_t k = 0; k < 2; ++k) {
            const std::vector<Point<D>> start = random_points<D>(50, 2);
            std::vector<Point<D>> x = start;
            advance<D>(*motion, x, 0, 2, {Scheme::rk4, 100 << k});
            for (std::size_t i = 0; i < x.size(); ++i) {
                errors[k] = std::max(errors[k], distance(x[i], (*motion->map(0, 2))(start[i])));
            }
        }
        CAPTURE(errors[0], errors[1]);
        if (errors[0] > 1e-12) { // a parabola is integrated exactly
            CHECK(std::log2(errors[0] / errors[1]) == Approx(4).margin(0.3));
        }
        CHECK(errors[0] < 1e-3);
    }
}

TEST_CASE("angles compose as OpenFOAM's: yaw first, about z, then pitch, about y, then roll, about x") {
    RigidTable<3> table{{0, 1}, {}, {{0, 0, 0}, {pi / 2, 0, pi / 2}}, {}};
    const AffineMap<3> map = *rigid_table<3>(table, {})->map(0, 1);
    CHECK(distance(map({1, 0, 0}), Point<3>{0, 0, 1}) < 1e-15); // x -> y by yaw -> z by roll
    table.angles[1] = {0, pi / 2, pi / 2};
    CHECK(distance((*rigid_table<3>(table, {})->map(0, 1))({0, 1, 0}), Point<3>{0, 0, 1}) < 1e-15);
}

TEST_CASE("a quaternion turns as its axis and angle say, right-handed") {
    const double half = std::sqrt(0.5);
    const RigidTable<3> table{{0, 1}, {}, {}, {{1, 0, 0, 0}, {-half, 0, 0, -half}}};
    const auto motion = rigid_table<3>(table, {});
    CHECK(distance((*motion->map(0, 1))({1, 0, 0}), Point<3>{0, 1, 0}) < 1e-15);
    CHECK(velocity_at<3>(*motion, {1, 0, 0}, 0)[1] > 0); // the short way, whatever the sign
}

TEST_CASE("angles of several turns between two rows are turned through") {
    const auto turning = rotation<2>({}, {1, 0}, AngleTable{{0, 2}, {0.1, 0.1 + 6 * pi}});
    CHECK(distance((*turning->map(0, 2))({2, 0}), Point<2>{2, 0}) < 1e-14);
    CHECK(distance((*turning->map(0, 1.0 / 3))({2, 0}), Point<2>{0, 0}) < 1e-14);
    CHECK(distance(velocity_at<2>(*turning, {2, 0}, 1), Point<2>{0, 3 * pi}) < 1e-14);
}

TEST_CASE("a rotation by a table of evenly growing angles is the rotation with that rate") {
    const Point<3> axis{1, 2, -2};
    const auto by_rate = rotation<3>(axis, pivot, 1.7);
    AngleTable table{instants(6), {}};
    for (const double t : table.times) {
        table.angles.push_back(1.7 * t - 40);
    }
    const auto by_table = rotation<3>(axis, pivot, table);
    for (const Point<3>& x : random_points<3>(20, 3)) {
        CHECK(distance((*by_table->map(0.3, 1.9))(x), (*by_rate->map(0.3, 1.9))(x)) < 1e-12);
        CHECK(distance(velocity_at<3>(*by_table, x, 1.1), velocity_at<3>(*by_rate, x, 1.1)) < 1e-12);
    }
}

TEST_CASE("cubics are reproduced by four rows or more, parabolas by three, lines by two") {
    for (std::size_t rows = 2; rows <= 9; ++rows) {
        const auto truth = [rows](double t) {
            return rows == 2 ? 3 * t - 1 : rows == 3 ? 2 * t * t - t : t * t * t - 4 * t * t + t;
        };
        RigidTable<2> table;
        for (std::size_t i = 0; i < rows; ++i) {
            const double t = 0.2 * static_cast<double>(i * i) + static_cast<double>(i);
            table.times.push_back(t);
            table.shifts.push_back({truth(t), 0});
        }
        const auto motion = rigid_table<2>(table, {});
        for (double s = 0; s <= 1; s += 0.05) {
            const double t = s * table.times.back();
            CHECK((*motion->map(0, t))({})[0] + truth(0) == Approx(truth(t)).margin(1e-10));
        }
    }
}

TEST_CASE("outside its times a table is not known, and says from when to when it is") {
    const auto motion = rigid_table<2>(in_plane(5), {});
    CHECK_THROWS_AS(motion->map(0, 2.001), GeometryError);
    CHECK_THROWS_WITH(motion->map(-0.1, 1), Catch::Contains("from t = 0 to 2") && Catch::Contains("-0.1"));
    CHECK_THROWS_AS(velocity_at<2>(*motion, {}, std::nan("")), GeometryError);
    CHECK_NOTHROW(motion->map(0, std::nextafter(2.0, 3.0))); // levels and substeps round
}

TEST_CASE("tables that make no sense are refused with their row") {
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK_THAT(refusal<2>({{0}, {}, {{1}}, {}}), Catch::Contains("two rows"));
    CHECK_THAT(refusal<2>({{}, {}, {}, {}}), Catch::Contains("two rows"));
    CHECK_THAT(refusal<2>({{0, 1, 1}, {}, {{0}, {1}, {2}}, {}}), Catch::Contains("row 2"));
    CHECK_THAT(refusal<2>({{0, 2, 1}, {}, {{0}, {1}, {2}}, {}}), Catch::Contains("row 2"));
    CHECK_THAT(refusal<2>({{0, std::nan("")}, {}, {{0}, {1}}, {}}), Catch::Contains("row 1"));
    CHECK_THAT(refusal<2>({{0, 1}, {}, {{0}, {infinite}}, {}}), Catch::Contains("row 1"));
    CHECK_THAT(refusal<2>({{0, 1}, {{0, 0}, {infinite, 0}}, {}, {}}), Catch::Contains("row 1"));
    CHECK_THAT(refusal<2>({{0, 1}, {{0, 0}}, {}, {}}), Catch::Contains("1 rows of displacements"));
    CHECK_THAT(refusal<2>({{0, 1}, {}, {}, {{1, 0, 0, 0}, {1, 0, 0, 0}}}), Catch::Contains("quaternions"));
    CHECK_THAT(refusal<3>({{0, 1}, {}, {}, {{1, 0, 0, 0}, {0.9, 0, 0, 0}}}), Catch::Contains("row 1"));
    CHECK_THAT(refusal<3>({{0, 1}, {}, {}, {{1, 0, 0, 0}, {0, 0, 0, 0}}}), Catch::Contains("row 1"));
    CHECK_THAT(refusal<3>({{0, 1}, {}, {}, {{1, 0, 0, 0}, {0, 1, 0, 0}}}), Catch::Contains("half a turn"));
    CHECK_THAT(refusal<3>({{0, 1}, {}, {{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}}),
               Catch::Contains("not by both"));
    CHECK(refusal<3>({{0, 1}, {}, {}, {{1, 0, 0, 0}, {0.9997, 0, 0.02, 0}}}) == "accepted");
    CHECK_THROWS_AS(rotation<2>({}, {}, AngleTable{{0, 1}, {}}), UsageError);
    CHECK_THROWS_AS(rotation<3>(no_axis, {}, AngleTable{{0, 1}, {0, 1}}), UsageError);
    CHECK_THROWS_AS(rotation<2>({}, {std::nan(""), 0}, AngleTable{{0, 1}, {0, 1}}), UsageError);
}

TEST_CASE(
    "quaternions that turn back and forth too far between rows are refused where they lose their sense") {
    RigidTable<3> table{{0, 0.1, 0.6, 1.1}, {}, {}, {}};
    for (const double half : {0.0, 1.5, 2.5, 1.5}) { // of turns about x
        table.quaternions.push_back({std::cos(half), std::sin(half), 0, 0});
    }
    const auto motion = rigid_table<3>(table, {});
    CHECK_THROWS_WITH(
        [&] {
            for (double t = 0; t <= 1.1; t += 0.001) {
                motion->map(0, t);
            }
        }(),
        Catch::Contains("more rows"));
}
