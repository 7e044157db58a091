// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/size_field.h"

#include "slabhull/core/vector.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace slabhull;

namespace {

template<int D>
struct Cloud {
    std::vector<Point<D>> points;
    std::vector<double> spacing;

    void add(const Point<D>& p, double h) {
        points.push_back(p);
        spacing.push_back(h);
    }
};

/// h(x) as it is defined.
template<int D>
double by_definition(const Cloud<D>& cloud, const Grading& grading, const Point<D>& x) {
    double least = grading.largest;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        least = std::min(least, cloud.spacing[i] + grading.growth * distance(cloud.points[i], x));
    }
    return least;
}

/// Points anywhere, spacings over some orders of magnitude.
template<int D>
Cloud<D> random_cloud(std::size_t count, double smallest, unsigned seed) {
    std::mt19937_64 random{seed};
    std::uniform_real_distribution<double> place{-1, 1};
    std::uniform_real_distribution<double> magnitude{std::log(smallest), std::log(0.5)};
    Cloud<D> cloud;
    for (std::size_t i = 0; i < count; ++i) {
        Point<D> p;
        for (double& x : p) {
            x = place(random);
        }
        cloud.add(p, std::exp(magnitude(random)));
    }
    return cloud;
}

Cloud<2> circle(std::size_t count, double radius) {
    Cloud<2> cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        cloud.add({radius * std::cos(angle), radius * std::sin(angle)},
                  2 * std::numbers::pi * radius / static_cast<double>(count));
    }
    return cloud;
}

Cloud<3> sphere(std::size_t count) {
    Cloud<3> cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = -1 + (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        cloud.add({r * std::cos(angle), r * std::sin(angle), z},
                  std::sqrt(4 * std::numbers::pi / static_cast<double>(count)));
    }
    return cloud;
}

template<int D>
SizeField<D> field_of(const Cloud<D>& cloud, const Grading& grading) {
    return {cloud.points, cloud.spacing, grading};
}

/// Compares with the definition at random places in the box of the points; returns the mean relative excess.
template<int D>
double check_against_definition(const Cloud<D>& cloud, const Grading& grading, int samples = 2000) {
    const SizeField<D> field = field_of(cloud, grading);
    Point<D> low = cloud.points[0];
    Point<D> high = low;
    for (const Point<D>& p : cloud.points) {
        for (std::size_t k = 0; k < D; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    std::mt19937_64 random{7};
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        Point<D> x;
        for (std::size_t k = 0; k < D; ++k) {
            x[k] = std::uniform_real_distribution<double>{low[k], high[k]}(random);
        }
        const double excess = field(x) / by_definition<D>(cloud, grading, x) - 1;
        least = std::min(least, excess);
        most = std::max(most, excess);
        sum += excess;
    }
    CHECK(least > -1e-14);
    CHECK(most < SizeField<D>::tolerance);
    return sum / samples;
}

} // namespace

TEST_CASE("the field is never below its definition and within the tolerance above it", "[size_field]") {
    for (const double growth : {0.05, 0.3, 1.0, 3.0}) {
        for (const double largest : {0.1, std::numeric_limits<double>::infinity()}) {
            const Grading grading{growth, largest};
            CHECK(check_against_definition(circle(500, 1), grading) < 0.02);
            CHECK(check_against_definition(sphere(500), grading) < 0.05);
            check_against_definition(random_cloud<2>(300, 1e-4, 1), grading);
            check_against_definition(random_cloud<3>(300, 1e-4, 2), grading);
        }
    }
}

TEST_CASE("one point makes an exact cone", "[size_field]") {
    Cloud<3> cloud;
    cloud.add({1, 2, 3}, 0.25);
    const SizeField<3> field = field_of(cloud, {0.5});
    CHECK(field({1, 2, 3}) == 0.25);
    CHECK(field({4, 6, 3}) == Approx(0.25 + 0.5 * 5));
    CHECK(field.box_count() == 1);
}

TEST_CASE("without growth the spacing is the smallest one everywhere", "[size_field]") {
    Cloud<2> cloud = circle(1000, 1);
    cloud.add({0.1, 0.2}, 1e-5);
    const SizeField<2> field = field_of(cloud, {0.0});
    CHECK(field({-0.9, 0.7}) == 1e-5);
    CHECK(field({0.1, 0.2}) == 1e-5);
    CHECK(field.box_count() == 1);
}

TEST_CASE("without points the spacing is the largest one", "[size_field]") {
    const SizeField<2> field{{}, {}, {0.3, 0.75}};
    CHECK(field({12, -3}) == 0.75);
}

TEST_CASE("the largest spacing cuts the field off, and saves boxes", "[size_field]") {
    const Cloud<2> cloud = circle(1000, 1);
    const SizeField<2> open = field_of(cloud, {0.3});
    const SizeField<2> cut = field_of(cloud, {0.3, 0.02});
    CHECK(open({0, 0}) > 0.2);
    CHECK(cut({0, 0}) == 0.02);
    CHECK(cut.box_count() < open.box_count());
}

TEST_CASE("places outside the box of the points are answered from its rim", "[size_field]") {
    const Cloud<2> cloud = circle(100, 1);
    const Grading grading{0.3};
    const SizeField<2> field = field_of(cloud, grading);
    for (const Point<2>& x : {Point<2>{5, 0}, Point<2>{-3, 4}, Point<2>{1e6, -1e6}, Point<2>{0, -1.5}}) {
        const double wanted = by_definition<2>(cloud, grading, x);
        CHECK(field(x) >= wanted * (1 - 1e-14));
        CHECK(field(x) < wanted * 1.5);
    }
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK(field({infinite, 0}) == infinite);
}

TEST_CASE("a huge ratio of sizes costs boxes only where it is small", "[size_field]") {
    Cloud<3> cloud;
    cloud.add({0.3, 0.3, 0.3}, 1e-13);
    cloud.add({1, 1, 1}, 1);
    cloud.add({0, 0, 0}, 1);
    const SizeField<3> field = field_of(cloud, {0.2});
    CHECK(field.box_count() < 20000);
    CHECK(field({0.3, 0.3, 0.3}) == 1e-13);
    check_against_definition(cloud, {0.2});
}

TEST_CASE("coincident points and points on a line do no harm", "[size_field]") {
    Cloud<2> cloud;
    for (int i = 0; i < 50; ++i) {
        cloud.add({i / 10 * 0.1, 0}, 0.1 + 0.01 * (i % 10));
    }
    check_against_definition(cloud, {0.3});
    Cloud<2> pile;
    pile.add({2, 2}, 0.4);
    pile.add({2, 2}, 0.3);
    CHECK(field_of(pile, {0.3})({2, 2}) == 0.3);
}

TEST_CASE("the field jumps by less than the tolerance between neighbours", "[size_field]") {
    const SizeField<2> field = field_of(circle(200, 1), {0.3});
    std::mt19937_64 random{3};
    std::uniform_real_distribution<double> place{-1, 1};
    for (int i = 0; i < 5000; ++i) {
        const Point<2> x{place(random), place(random)};
        const Point<2> y{x[0] + 1e-9, x[1] - 1e-9};
        CHECK(std::abs(field(x) - field(y)) < 0.15 * field(x));
    }
}

TEST_CASE("scaling space by a power of two scales the field exactly", "[size_field]") {
    const Cloud<2> cloud = random_cloud<2>(200, 1e-3, 5);
    Cloud<2> large;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        large.add({1024 * cloud.points[i][0], 1024 * cloud.points[i][1]}, 1024 * cloud.spacing[i]);
    }
    const SizeField<2> field = field_of(cloud, {0.3});
    const SizeField<2> large_field = field_of(large, {0.3});
    CHECK(field.box_count() == large_field.box_count());
    for (double x = -1; x < 1; x += 0.0837) {
        CHECK(large_field({1024 * x, 512 * x}) == 1024 * field({x, x / 2}));
    }
}

TEST_CASE("the cubes of the wanted size fill the box", "[size_field]") {
    Cloud<3> cloud;
    cloud.add({0, 0, 0}, 0.1);
    cloud.add({2, 1, 1}, 0.5);
    CHECK(field_of(cloud, {0.0}).cube_count() == Approx(8 * 1000));
    const SizeField<3> graded = field_of(cloud, {0.3});
    double sum = 0;
    int samples = 0;
    for (double x = 0.05; x < 2; x += 0.1) {
        for (double y = 0.05; y < 2; y += 0.1) {
            for (double z = 0.05; z < 2; z += 0.1) {
                sum += std::pow(by_definition<3>(cloud, {0.3}, {x, y, z}), -3);
                ++samples;
            }
        }
    }
    CHECK(graded.cube_count() == Approx(8 * sum / samples).epsilon(0.1));
}

TEMPLATE_TEST_CASE_SIG("a part of the field says what the whole does in its boxes, and is smaller",
                       "[size_field]", ((int D), D), 2, 3) {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> unit{0, 1};
    Cloud<D> cloud;
    for (int k = 0; k < 500; ++k) {
        Point<D> p;
        std::generate(p.begin(), p.end(), [&] { return 1000 + unit(random); });
        cloud.add(p, 0.001 + 0.05 * unit(random) * unit(random));
    }
    const SizeField<D> whole{cloud.points, cloud.spacing, {0.3}};
    std::vector<std::array<Point<D>, 2>> boxes(2);
    for (std::size_t k = 0; k < D; ++k) {
        boxes[0][0][k] = 1000.1;
        boxes[0][1][k] = 1000.25;
        boxes[1][0][k] = 1000.7;
        boxes[1][1][k] = 1000.7; // a single place
    }
    const SizeField<D> part = whole.part_within(boxes);
    CHECK(part.box_count() < whole.box_count() / 3);
    CHECK(part.source_bytes().size() < whole.source_bytes().size());
    CHECK(part(boxes[1][0]) == whole(boxes[1][0]));
    for (int k = 0; k < 2000; ++k) {
        Point<D> p;
        std::generate(p.begin(), p.end(), [&] { return 1000.1 + 0.15 * std::min(1.0, 1.2 * unit(random)); });
        REQUIRE(part(p) == whole(p));
    }
    CHECK(whole.part_within({}).box_count() == 1);
    const Point<D> low = cloud.points.front();
    CHECK(SizeField<D>{std::span<const Point<D>>{}, {}, {0.3, 2}}.part_within(boxes)(low) == 2);
}

TEST_CASE("the spacing of a boundary vertex is the mean length of the edges at it", "[size_field]") {
    const std::vector<Point<2>> corners{{0, 0}, {3, 0}, {3, 4}, {9, 9}};
    const std::vector<Facet<2>> triangle{{0, 1}, {1, 2}, {2, 0}};
    const std::vector<double> flat = boundary_spacing<2>(corners, triangle);
    CHECK(flat[0] == 4);
    CHECK(flat[1] == 3.5);
    CHECK(flat[2] == 4.5);
    CHECK(flat[3] == std::numeric_limits<double>::infinity());

    const std::vector<Point<3>> tips{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<Facet<3>> tetrahedron{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const std::vector<double> solid = boundary_spacing<3>(tips, tetrahedron);
    CHECK(solid[0] == Approx(1));
    CHECK(solid[1] == Approx((1 + 2 * std::sqrt(2.0)) / 3));
}
