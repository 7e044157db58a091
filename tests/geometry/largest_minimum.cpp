// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/basics/largest_minimum.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace slabhull;

namespace {

template<int N>
double least(const std::vector<AffineFunction<N>>& functions, const Point<N>& x) {
    double value = std::numeric_limits<double>::infinity();
    for (const auto& function : functions) {
        value = std::min(value, function.at(x));
    }
    return value;
}

template<int N>
Point<N> solved(const std::vector<AffineFunction<N>>& functions) {
    return largest_minimum<N>(std::span<const AffineFunction<N>>{functions});
}

template<int N>
Point<N> random_point(std::mt19937& random, double size) {
    std::normal_distribution<double> normal(0, size);
    Point<N> x;
    for (double& coordinate : x) {
        coordinate = normal(random);
    }
    return x;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the largest minimum in a box is half its narrowest width", "[largest_minimum]",
                       ((int N), N), 2, 3, 4) {
    std::vector<AffineFunction<N>> walls;
    for (std::size_t k = 0; k < N; ++k) {
        AffineFunction<N> low{{}, 1};
        low.gradient[k] = 1;
        AffineFunction<N> high{{}, static_cast<double>(k)};
        high.gradient[k] = -1;
        walls.push_back(low);
        walls.push_back(high);
    }
    CHECK(least<N>(walls, solved<N>(walls)) == Approx(0.5));
}

TEMPLATE_TEST_CASE_SIG("no point near the one that is found is better", "[largest_minimum]", ((int N), N), 2,
                       3, 4) {
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        std::vector<AffineFunction<N>> functions;
        for (int k = 0; k < 40; ++k) {
            const Point<N> gradient = random_point<N>(random, 1);
            functions.push_back({gradient, random_point<N>(random, 1)[0]});
        }
        const Point<N> found = solved<N>(functions);
        const double value = least<N>(functions, found);
        for (const double size : {1.0, 0.1, 1e-3, 1e-5}) {
            for (int k = 0; k < 50; ++k) {
                Point<N> other = random_point<N>(random, size);
                for (std::size_t j = 0; j < N; ++j) {
                    other[j] += found[j];
                }
                REQUIRE(least<N>(functions, other) <= value + 1e-9);
            }
        }
    }
}

TEST_CASE("a program without a bound ends at a point that is finite", "[largest_minimum]") {
    const Point<3> found = solved<3>({{{1, 0, 0}, 0}});
    CHECK(std::isfinite(found[0] + found[1] + found[2]));
    CHECK(found[0] > 1);
}
