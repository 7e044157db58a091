// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/study/exact_measures.h"

#include "slabhull/cases/experiments.h"
#include "slabhull/core/error.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

using namespace slabhull;

namespace {

constexpr double digits = 1e-12;
using std::numbers::pi;
using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The integral over [0, 1] by the double exponential rule, of doubled density until nothing changes.
double integral(const std::function<double(double)>& f) {
    double before = 1e300;
    for (double step = 0.25;; step /= 2) {
        double sum = 0;
        for (double k = -std::round(3.2 / step); k * step <= 3.2; ++k) {
            const double u = pi / 2 * std::sinh(k * step);
            sum += f(0.5 * (1 + std::tanh(u))) * pi / 4 * std::cosh(k * step) / (std::cosh(u) * std::cosh(u));
        }
        if (std::abs(sum * step - before) < 1e-14 * std::abs(before) || step < 1e-3) {
            return sum * step;
        }
        before = sum * step;
    }
}

/// The side of an ellipsoid that turns about z, from tangents and velocity: with N = x_u x x_v, the element
/// is
/// |(N, N.v)|. Angles are about the x axis, not about z as in the library.
double swept_by_tangents(const Vector& a, double rate) {
    return integral([&](double along) {
        constexpr int sectors = 1200;
        const double theta = pi * along;
        double ring = 0;
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2 * pi * (j + 0.3) / sectors;
            const double s = std::sin(theta), c = std::cos(theta), sp = std::sin(phi), cp = std::cos(phi);
            const Vector x{a[0] * c, a[1] * s * cp, a[2] * s * sp};
            const Vector by_theta{-a[0] * s, a[1] * c * cp, a[2] * c * sp};
            const Vector by_phi{0, -a[1] * s * sp, a[2] * s * cp};
            const Vector normal = cross(by_theta, by_phi);
            const Vector velocity{-rate * x[1], rate * x[0], 0};
            ring += std::hypot(std::sqrt(dot(normal, normal)), dot(normal, velocity));
        }
        return ring * 2 * pi / sectors * pi;
    });
}

/// The measures of a body of radius 1 + growth t in a box of this edge, as integrals over time.
struct Radial {
    int dimension;
    double edge;
    double growth;

    double ball(double r) const { return dimension == 2 ? pi * r * r : 4 * pi / 3 * r * r * r; }
    double sphere(double r) const { return dimension == 2 ? 2 * pi * r : 4 * pi * r * r; }
    double domain(double t) const { return std::pow(edge, dimension) - ball(1 + growth * t); }
    double side() const {
        return 2 * dimension * std::pow(edge, dimension - 1) +
               integral([&](double t) { return sphere(1 + growth * t) * std::sqrt(1 + growth * growth); });
    }
    double enclosed() const {
        return integral([&](double t) { return domain(t); });
    }
};

void check_radial(const std::string& name, const Radial& body) {
    INFO(name);
    const ExactMeasures exact = exact_measures(name);
    CHECK(exact.initial == Approx(body.domain(0)).epsilon(digits));
    CHECK(exact.terminating == Approx(body.domain(1)).epsilon(digits));
    CHECK(exact.side == Approx(body.side()).epsilon(digits));
    CHECK(exact.enclosed == Approx(body.enclosed()).epsilon(digits));
    CHECK(exact.hull() == Approx(body.domain(0) + body.domain(1) + body.side()).epsilon(digits));
}

} // namespace

TEST_CASE("the measures of bodies that rest or expand are their integrals over time", "[exact-measures]") {
    check_radial("circle", {2, 10, 0});
    check_radial("expanding-circle", {2, 10, 0.25});
    check_radial("sphere", {3, 10, 0});
    check_radial("expanding-sphere", {3, 10, 0.25});
}

TEST_CASE("the hull of the expanding sphere has the paper's closed form", "[exact-measures]") {
    const double closed = 2000 - 4 * pi / 3 * (std::pow(1.25, 3) + 1) + 600 +
                          4 * pi / 3 * (std::pow(1.25, 3) - 1) / 0.25 * std::hypot(0.25, 1);
    CHECK(exact_measures("expanding-sphere").hull() == Approx(closed).epsilon(digits));
}

TEST_CASE("what a turning ellipsoid sweeps is what other parameters and another rule give",
          "[exact-measures]") {
    for (const Vector& axes : {Vector{1, 3, 2}, Vector{3, 1, 2}, Vector{1, 1.1, 5}}) {
        for (const double rate : {0.0, 0.3, pi / 2, -4.0}) {
            INFO(axes[0] << ", " << axes[1] << ", " << axes[2] << " at " << rate);
            CHECK(turning_ellipsoid_measure(axes, rate) ==
                  Approx(swept_by_tangents(axes, rate)).epsilon(digits));
        }
    }
}

TEST_CASE("a sphere sweeps its area however it turns; a spheroid at rest has a closed form",
          "[exact-measures]") {
    CHECK(turning_ellipsoid_measure({1, 1, 1}, 1.5) == Approx(4 * pi).epsilon(digits));
    const double e = std::sqrt(1 - 1.0 / 9); // of the prolate spheroid (1, 1, 3)
    CHECK(turning_ellipsoid_measure({1, 1, 3}, 7) ==
          Approx(2 * pi * (1 + 3 / e * std::asin(e))).epsilon(digits));
}

TEST_CASE("the turning experiments are a cube less their bodies, and what bodies and cube sweep",
          "[exact-measures]") {
    const ExactMeasures one = exact_measures("ellipsoid");
    CHECK(one.initial == Approx(4096 - 8 * pi).epsilon(digits));
    CHECK(one.terminating == one.initial);
    CHECK(one.enclosed == one.initial);
    CHECK(one.side == Approx(1536 + swept_by_tangents({1, 3, 2}, pi / 2)).epsilon(digits));
    const ExactMeasures two = exact_measures("tandem-ellipsoids");
    CHECK(two.terminating == Approx(8000 - 16 * pi).epsilon(digits));
    CHECK(two.side == Approx(2400 + 2 * swept_by_tangents({1, 3, 2}, pi / 2)).epsilon(digits));
}

TEST_CASE("every experiment has exact measures; others are refused", "[exact-measures]") {
    CHECK(experiment_names().size() == 6);
    for (const std::string& name : experiment_names()) {
        CHECK(exact_measures(name).hull() > 0);
    }
    CHECK_THROWS_WITH(exact_measures("square"), Catch::Contains("tandem-ellipsoids"));
}

TEST_CASE("the paper's tables have 48 rows, and twice as many triangles as vertices", "[exact-measures]") {
    std::size_t rows = 0;
    for (const std::string& name : experiment_names()) {
        for (const ExperimentLevel& level : experiment_levels(name)) {
            ++rows;
            if (name.ends_with("circle")) {
                CHECK(level.paper.cells == 2 * level.paper.vertices);
            }
        }
    }
    CHECK(rows == 48);
}
