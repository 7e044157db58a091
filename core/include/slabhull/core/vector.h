// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Arithmetic on points and vectors of R^N.
namespace slabhull {

template<std::size_t N>
std::array<double, N> plus(const std::array<double, N>& a, const std::array<double, N>& b) {
    std::array<double, N> sum;
    std::transform(a.begin(), a.end(), b.begin(), sum.begin(), [](double p, double q) { return p + q; });
    return sum;
}

template<std::size_t N>
std::array<double, N> minus(const std::array<double, N>& a, const std::array<double, N>& b) {
    std::array<double, N> difference;
    std::transform(a.begin(), a.end(), b.begin(), difference.begin(),
                   [](double p, double q) { return p - q; });
    return difference;
}

template<std::size_t N>
std::array<double, N> times(double factor, std::array<double, N> a) {
    for (double& entry : a) {
        entry *= factor;
    }
    return a;
}

template<std::size_t N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

inline std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template<std::size_t N>
double norm(const std::array<double, N>& a) {
    return std::sqrt(dot(a, a));
}

template<std::size_t N>
bool all_finite(const std::array<double, N>& a) {
    return std::all_of(a.begin(), a.end(), [](double entry) { return std::isfinite(entry); });
}

template<std::size_t N>
double squared_distance(const std::array<double, N>& a, const std::array<double, N>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < N; ++k) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return sum;
}

template<std::size_t N>
double distance(const std::array<double, N>& a, const std::array<double, N>& b) {
    return std::sqrt(squared_distance(a, b));
}

} // namespace slabhull
