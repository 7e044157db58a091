// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/study/exact_measures.h"

#include "slabhull/cases/experiments.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace slabhull {

namespace {

using std::numbers::pi;

struct Node {
    double z;
    double weight;
};

/// Node i of the Gauss-Legendre rule of order n on [-1, 1], by Newton's method.
Node gauss_node(int n, int i) {
    double z = std::cos(pi * (i + 0.75) / (n + 0.5));
    double slope = 0;
    for (double move = 1; std::abs(move) > 1e-15;) {
        double p = 1; // Legendre's polynomials by their recurrence
        double before = 0;
        for (int k = 0; k < n; ++k) {
            const double next = ((2 * k + 1) * z * p - k * before) / (k + 1);
            before = p;
            p = next;
        }
        slope = n * (z * p - before) / (z * z - 1);
        move = p / slope;
        z -= move;
    }
    return {z, 2 / ((1 - z * z) * slope * slope)};
}

/// A radius that grows linearly from 1 to R within a unit of time.
struct Expansion {
    double final_radius;

    double mean_square() const { return (1 + final_radius + final_radius * final_radius) / 3; }
    double mean_cube() const { return (1 + final_radius) * (1 + final_radius * final_radius) / 4; }
    /// Of space-time distance to time: the length of a boundary point's path.
    double stretch() const { return std::hypot(final_radius - 1, 1.0); }
};

ExactMeasures square_with_circle(double edge, const Expansion& circle) {
    const double area = edge * edge;
    const double radius = circle.final_radius;
    return {area - pi, 4 * edge + pi * (radius + 1) * circle.stretch(), area - pi * radius * radius,
            area - pi * circle.mean_square()};
}

ExactMeasures cube_with_sphere(double edge, const Expansion& sphere) {
    const double volume = edge * edge * edge;
    const double ball = 4 * pi / 3;
    return {volume - ball, 6 * edge * edge + 4 * pi * sphere.mean_square() * sphere.stretch(),
            volume - ball * std::pow(sphere.final_radius, 3), volume - ball * sphere.mean_cube()};
}

/// Bodies with these semi-axes, each turning a quarter about its centre; the direction makes no difference.
ExactMeasures cube_with_turning(double edge, const std::vector<std::array<double, 3>>& bodies) {
    double inside = edge * edge * edge;
    double side = 6 * edge * edge;
    for (const auto& axes : bodies) {
        inside -= 4 * pi / 3 * axes[0] * axes[1] * axes[2];
        side += turning_ellipsoid_measure(axes, pi / 2);
    }
    return {inside, side, inside, inside};
}

} // namespace

double turning_ellipsoid_measure(const std::array<double, 3>& a, double rate) {
    // Gauss's rule in z = cos(theta); in phi, of which the integrand is periodic and smooth, equal steps
    // converge faster than any power.
    constexpr int rings = 400;
    constexpr int sectors = 800;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const auto [z, weight] = gauss_node(rings, i);
        const double s = std::sqrt(1 - z * z);
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2 * pi * j / sectors;
            const std::array<double, 3> u{s * std::cos(phi), s * std::sin(phi), z};
            // x = A u: the element of area is |det A| |A^-1 u|, the normal A^-1 u / |A^-1 u|.
            const std::array<double, 3> g{u[0] / a[0], u[1] / a[1], u[2] / a[2]};
            const double length = std::hypot(g[0], g[1], g[2]);
            const double normal_speed = rate * (-a[1] * u[1] * g[0] + a[0] * u[0] * g[1]) / length;
            sum += weight * a[0] * a[1] * a[2] * length * std::hypot(1.0, normal_speed);
        }
    }
    return sum * 2 * pi / sectors;
}

ExactMeasures exact_measures(const std::string& experiment) {
    experiment_levels(experiment); // which refuses unknown names
    const Expansion body{experiment.starts_with("expanding") ? 1.25 : 1.0};
    if (experiment.ends_with("circle")) {
        return square_with_circle(10, body);
    }
    if (experiment.ends_with("sphere")) {
        return cube_with_sphere(10, body);
    }
    if (experiment == "ellipsoid") {
        return cube_with_turning(16, {{1, 3, 2}});
    }
    return cube_with_turning(20, {{1, 3, 2}, {3, 1, 2}});
}

} // namespace slabhull
