// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/simplex_sign.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <utility>

using namespace slabhull;

namespace {

template<int N>
using Corners = std::array<Point<N>, N + 1>;

template<int N>
Corners<N> unit_simplex() {
    Corners<N> corners{};
    for (std::size_t k = 0; k < N; ++k) {
        corners[k + 1][k] = 1;
    }
    return corners;
}

template<int N>
Corners<N> random_simplex(std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate{-1, 1};
    Corners<N> corners;
    for (Point<N>& corner : corners) {
        for (double& entry : corner) {
            entry = coordinate(random);
        }
    }
    return corners;
}

/// The last corner is put among the others: on their hyperplane, if sums were not rounded.
template<int N>
Corners<N> nearly_flat(std::mt19937& random) {
    Corners<N> corners = random_simplex<N>(random);
    for (std::size_t k = 0; k < N; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < N; ++i) {
            sum += static_cast<double>(i + 1) * corners[i][k];
        }
        corners[N][k] = sum / (N * (N + 1) / 2);
    }
    return corners;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the sign of a simplex is that of its corners' order", "[sign]", ((int N), N), 2, 3,
                       4) {
    std::mt19937 random{7};
    for (int k = 0; k < 200; ++k) {
        Corners<N> corners = k == 0 ? unit_simplex<N>() : random_simplex<N>(random);
        const int sign = simplex_sign<N>(corners);
        CHECK((k > 0 || sign == 1));
        CHECK(std::abs(sign) == 1);
        std::swap(corners[0], corners[N]);
        CHECK(simplex_sign<N>(corners) == -sign);
        std::swap(corners[1], corners[N - 1]);
        CHECK(simplex_sign<N>(corners) == (N == 2 ? -sign : sign));
    }
}

TEMPLATE_TEST_CASE_SIG("a simplex that is flat to rounding has the same sign whichever corner comes first",
                       "[sign]", ((int N), N), 2, 3, 4) {
    std::mt19937 random{11};
    int flat = 0;
    for (int k = 0; k < 300; ++k) {
        Corners<N> corners = nearly_flat<N>(random);
        const int sign = simplex_sign<N>(corners);
        flat += sign == 0 ? 1 : 0;
        for (std::size_t turn = 0; turn <= N; ++turn) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            const int parity = N % 2 == 0 || (turn + 1) % 2 == 0 ? 1 : -1; // a turn is N exchanges
            REQUIRE(simplex_sign<N>(corners) == parity * sign);
        }
    }
    CHECK(flat < 250); // rounding puts most of them aside
}

TEMPLATE_TEST_CASE_SIG("coordinates that leave the range of double do not deceive", "[sign]", ((int N), N), 2,
                       3, 4) {
    for (const double scale : {1e-200, 1e-320, 1e200, 1e307}) {
        Corners<N> corners = unit_simplex<N>();
        for (Point<N>& corner : corners) {
            for (double& entry : corner) {
                entry *= scale;
            }
        }
        CHECK(simplex_sign<N>(corners) == 1);
        corners[N] = corners[1];
        CHECK(simplex_sign<N>(corners) == 0);
    }
}
