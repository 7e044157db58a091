// SPDX-License-Identifier: BSD-3-Clause
// Exact measures of the paper's six experiments, t in [0, 1]. The lateral measure of a turning ellipsoid is
// the integral of sqrt(1 + v_n^2) over its surface, v_n the normal velocity, by quadrature.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace slabhull::exact {

struct Measures {
    double initial;
    double side;
    double terminating;
    double enclosed;
    double hull() const { return initial + side + terminating; }
};

/// Integral of sqrt(1 + v_n^2) over the ellipsoid with semi-axes a that turns about z at `rate`:
/// Gauss-Legendre in cos(theta), trapezoidal (spectral for a periodic integrand) in phi.
inline double turning_side(const std::array<double, 3>& a, double rate) {
    constexpr int rings = 400;
    constexpr int sectors = 800;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        // Node i of the Gauss-Legendre rule by Newton's method.
        double z = std::cos(std::numbers::pi * (i + 0.75) / (rings + 0.5));
        double slope = 0;
        for (int step = 0; step < 100; ++step) {
            double p = 1;
            double before = 0;
            for (int k = 0; k < rings; ++k) {
                const double next = ((2 * k + 1) * z * p - k * before) / (k + 1);
                before = p;
                p = next;
            }
            slope = rings * (z * p - before) / (z * z - 1);
            const double move = p / slope;
            z -= move;
            if (std::abs(move) < 1e-15) {
                break;
            }
        }
        const double weight = 2 / ((1 - z * z) * slope * slope);
        const double s = std::sqrt(1 - z * z);
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2 * std::numbers::pi * j / sectors;
            const std::array<double, 3> u{s * std::cos(phi), s * std::sin(phi), z};
            // With x = A u, the area element is |det A| |A^-1 u| and the normal A^-1 u / |A^-1 u|.
            const std::array<double, 3> g{u[0] / a[0], u[1] / a[1], u[2] / a[2]};
            const double length = std::hypot(g[0], g[1], g[2]);
            const double normal_speed = rate * (-a[1] * u[1] * g[0] + a[0] * u[0] * g[1]) / length;
            sum += weight * a[0] * a[1] * a[2] * length * std::hypot(1.0, normal_speed);
        }
    }
    return sum * 2 * std::numbers::pi / sectors;
}

inline Measures measures(const std::string& name) {
    using std::numbers::pi;
    constexpr double L = 10;
    const double slant = std::hypot(0.25, 1.0);
    const double final_radius = name.starts_with("expanding") ? 1.25 : 1.0;
    const double stretch = name.starts_with("expanding") ? slant : 1.0;
    const double R = final_radius;
    if (name == "circle" || name == "expanding-circle") {
        const double mean_square = (1 + R + R * R) / 3;
        return {L * L - pi, 4 * L + pi * (R + 1) * stretch, L * L - pi * R * R, L * L - pi * mean_square};
    }
    if (name == "sphere" || name == "expanding-sphere") {
        const double ball = 4 * pi / 3;
        const double mean_square = (1 + R + R * R) / 3;
        const double mean_cube = (1 + R) * (1 + R * R) / 4;
        return {L * L * L - ball, 6 * L * L + 4 * pi * mean_square * stretch, L * L * L - ball * R * R * R,
                L * L * L - ball * mean_cube};
    }
    const double quarter = pi / 2;
    const double body = 4 * pi / 3 * 6;
    if (name == "ellipsoid") {
        const double cap = 16.0 * 16 * 16 - body;
        return {cap, 6 * 16.0 * 16 + turning_side({1, 3, 2}, quarter), cap, cap};
    }
    if (name == "tandem-ellipsoids") {
        const double cap = 20.0 * 20 * 20 - 2 * body;
        return {cap, 6 * 20.0 * 20 + turning_side({1, 3, 2}, quarter) + turning_side({3, 1, 2}, quarter), cap,
                cap};
    }
    throw std::invalid_argument(name);
}

} // namespace slabhull::exact
