// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/shapes.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

using namespace slabhull;

namespace {

using std::numbers::pi;

/// Measure of the domain that a closed, outward oriented surface bounds.
double enclosed(const Surface<2>& surface) {
    double sum = 0;
    for (const auto& [a, b] : surface.facets) {
        const Point<2>& p = surface.points[a];
        const Point<2>& q = surface.points[b];
        sum += (p[1] * q[0] - p[0] * q[1]) / 2;
    }
    return sum;
}

double enclosed(const Surface<3>& surface) {
    double sum = 0;
    for (const auto& [a, b, c] : surface.facets) {
        const Point<3>& p = surface.points[a];
        const Point<3>& q = surface.points[b];
        const Point<3>& r = surface.points[c];
        sum += (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                p[2] * (q[0] * r[1] - q[1] * r[0])) /
               6;
    }
    return sum;
}

/// Closed and oriented: each vertex (D = 2) or directed edge (D = 3) is met exactly once each way.
bool is_closed(const Surface<2>& surface) {
    std::vector<int> starts(surface.points.size());
    std::vector<int> ends(surface.points.size());
    for (const auto& [a, b] : surface.facets) {
        ++starts[a];
        ++ends[b];
    }
    const std::vector<int> ones(surface.points.size(), 1);
    return starts == ones && ends == ones;
}

std::map<std::pair<Index, Index>, int> directed_edges(const Surface<3>& surface) {
    std::map<std::pair<Index, Index>, int> edges;
    for (const Facet<3>& facet : surface.facets) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++edges[{facet[i], facet[(i + 1) % 3]}];
        }
    }
    return edges;
}

bool is_closed(const Surface<3>& surface) {
    const auto edges = directed_edges(surface);
    return std::all_of(edges.begin(), edges.end(), [&](const auto& entry) {
        return entry.second == 1 && edges.contains({entry.first.second, entry.first.first});
    });
}

int euler_characteristic(const Surface<2>& surface) {
    return static_cast<int>(surface.points.size()) - static_cast<int>(surface.facets.size());
}

int euler_characteristic(const Surface<3>& surface) {
    return static_cast<int>(surface.points.size()) - static_cast<int>(directed_edges(surface).size() / 2) +
           static_cast<int>(surface.facets.size());
}

template<int D>
std::vector<double> edge_lengths(const Surface<D>& surface) {
    std::vector<double> lengths;
    for (const Facet<D>& facet : surface.facets) {
        for (std::size_t i = 0; i < D; ++i) {
            lengths.push_back(distance(surface.points[facet[i]], surface.points[facet[(i + 1) % D]]));
        }
    }
    std::sort(lengths.begin(), lengths.end());
    return lengths;
}

/// Smallest angle of any triangle, in degrees.
double smallest_angle(const Surface<3>& surface) {
    double smallest = 180;
    for (const Facet<3>& facet : surface.facets) {
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = distance(surface.points[facet[(i + 1) % 3]], surface.points[facet[(i + 2) % 3]]);
            const double b = distance(surface.points[facet[i]], surface.points[facet[(i + 1) % 3]]);
            const double c = distance(surface.points[facet[i]], surface.points[facet[(i + 2) % 3]]);
            smallest = std::min(smallest, std::acos((b * b + c * c - a * a) / (2 * b * c)) * 180 / pi);
        }
    }
    return smallest;
}

template<int D>
bool all_distinct(const Surface<D>& surface) {
    return std::set<Point<D>>(surface.points.begin(), surface.points.end()).size() == surface.points.size();
}

template<int D>
double largest_residual(const Surface<D>& surface, const Point<D>& centre, const Point<D>& axes) {
    double largest = 0;
    for (const Point<D>& x : surface.points) {
        double sum = -1;
        for (std::size_t i = 0; i < D; ++i) {
            sum += std::pow((x[i] - centre[i]) / axes[i], 2);
        }
        largest = std::max(largest, std::abs(sum));
    }
    return largest;
}

const Patch walls{7, "walls"};
const Patch body{3, "body"};

} // namespace

TEST_CASE("the helpers of these tests see a facet turned round and a facet lost") {
    Surface<3> box = box_surface<3>({0, 0, 0}, {1, 1, 1}, 0.5, walls);
    std::swap(box.facets[5][0], box.facets[5][1]);
    CHECK_FALSE(is_closed(box));
    box = box_surface<3>({0, 0, 0}, {1, 1, 1}, 0.5, walls);
    box.facets.pop_back();
    CHECK_FALSE(is_closed(box));
}

TEST_CASE("a box is closed, encloses its volume and divides its edges evenly") {
    for (const double size : {5.0, 1.0, 0.7, 0.26}) {
        const Surface<3> box = box_surface<3>({-1, 0, 2}, {1, 3, 2.5}, size, walls);
        CHECK(is_closed(box));
        CHECK(all_distinct(box));
        CHECK(euler_characteristic(box) == 2);
        CHECK(enclosed(box) == Approx(3).epsilon(1e-14));
        const double nx = std::ceil(2 / size);
        const double ny = std::ceil(3 / size);
        const double nz = std::ceil(0.5 / size);
        CHECK(static_cast<double>(box.facets.size()) == 4 * (nx * ny + ny * nz + nx * nz));
        CHECK(edge_lengths(box).back() <= std::sqrt(2.0) * size);
        CHECK(box.patch == std::vector<PatchNumber>(box.facets.size(), 7));
        CHECK(box.patches == PatchList{walls});
    }
}

TEST_CASE("a rectangle is closed, encloses its area and divides its edges evenly") {
    for (const double size : {5.0, 1.0, 0.7, 0.26}) {
        const Surface<2> box = box_surface<2>({-1, 0}, {1, 3}, size, walls);
        CHECK(is_closed(box));
        CHECK(all_distinct(box));
        CHECK(euler_characteristic(box) == 0);
        CHECK(enclosed(box) == Approx(6).epsilon(1e-14));
        CHECK(static_cast<double>(box.facets.size()) == 2 * (std::ceil(2 / size) + std::ceil(3 / size)));
        CHECK(edge_lengths(box).back() <= size * (1 + 1e-12));
    }
}

TEST_CASE("an edge that is a multiple of the size but for rounding gets no extra division") {
    CHECK(box_surface<2>({0, 0}, {0.3, 0.3}, 0.1, walls).facets.size() == 12);
    CHECK(box_surface<2>({0, 0}, {0.7, 0.7}, 0.1, walls).facets.size() == 28);
}

TEST_CASE("every facet of a box points outward") {
    const Surface<3> box = box_surface<3>({-1, -1, -1}, {1, 1, 1}, 0.5, walls);
    for (const Facet<3>& facet : box.facets) {
        Surface<3> cone{box.points, {facet}, {}, {}};
        CHECK(enclosed(cone) > 0);
    }
}

TEST_CASE("the diagonals on a face of a box alternate") {
    const Surface<3> box = box_surface<3>({0, 0, 0}, {4, 4, 4}, 1, walls);
    std::vector<int> diagonals(box.points.size());
    for (const auto& [edge, count] : directed_edges(box)) {
        const bool diagonal = distance(box.points[edge.first], box.points[edge.second]) > 1.2;
        diagonals[edge.first] += diagonal ? count : 0;
    }
    for (std::size_t i = 0; i < box.points.size(); ++i) {
        const Point<3>& x = box.points[i];
        const auto inner = std::count_if(x.begin(), x.end(), [](double c) { return c > 0 && c < 4; });
        if (inner == 2) {
            CHECK((diagonals[i] == 0 || diagonals[i] == 4));
        }
    }
}

TEST_CASE("boxes that are empty, or have too many parts to count, are refused") {
    CHECK_THROWS_AS(box_surface<2>({0, 0}, {1, 0}, 0.1, walls), UsageError);
    CHECK_THROWS_AS(box_surface<2>({0, 0}, {1, std::nan("")}, 0.1, walls), UsageError);
    CHECK_THROWS_AS(box_surface<3>({0, 0, 0}, {1, 1, 1}, 0, walls), UsageError);
    CHECK_THROWS_AS(box_surface<3>({0, 0, 0}, {1, 1, 1}, 1e-300, walls), LimitError);
    CHECK_THROWS_AS(box_surface<3>({0, 0, 0}, {1, 1, 1}, 2e-5, walls), LimitError);
    CHECK_THROWS_WITH(box_surface<2>({0, 0}, {1, 2.1e9}, 1, walls),
                      Catch::Contains("GB are free; give a larger size"));
}

TEST_CASE("an ellipse is a closed hole with its vertices on it, at nearly equal distances") {
    const Point<2> centre{3, -1};
    for (const Point<2>& axes : {Point<2>{1, 1}, {1, 3}, {2, 0.1}}) {
        for (const int n : {3, 8, 97, 1000}) {
            const Surface<2> ellipse = ellipsoid_body<2>(centre, axes, n, body);
            CHECK(static_cast<int>(ellipse.facets.size()) == n);
            CHECK(is_closed(ellipse));
            CHECK(ellipse.points[0] == Point<2>{3 + axes[0], -1});
            CHECK(largest_residual<2>(ellipse, centre, axes) < 1e-14 * 40);
            CHECK(enclosed(ellipse) < 0);
        }
        const Surface<2> fine = ellipsoid_body<2>(centre, axes, 2000, body);
        CHECK(enclosed(fine) == Approx(-pi * axes[0] * axes[1]).epsilon(1e-4));
        CHECK(edge_lengths(fine).front() > 0.97 * edge_lengths(fine).back());
    }
}

TEST_CASE("a geodesic sphere has the counts of its frequency and nearly equilateral triangles") {
    for (const int n : {1, 2, 3, 7, 20}) {
        const Surface<3> sphere = ellipsoid_body<3>({}, {1, 1, 1}, n, body);
        CHECK(static_cast<int>(sphere.points.size()) == 10 * n * n + 2);
        CHECK(static_cast<int>(sphere.facets.size()) == 20 * n * n);
        CHECK(is_closed(sphere));
        CHECK(all_distinct(sphere));
        CHECK(euler_characteristic(sphere) == 2);
        CHECK(smallest_angle(sphere) > 50);
        CHECK(edge_lengths(sphere).back() < 1.25 * edge_lengths(sphere).front());
    }
}

TEST_CASE("an ellipsoid has its vertices on it and loses volume with the square of the spacing") {
    const Point<3> centre{1, 2, 3};
    for (const Point<3>& axes : {Point<3>{1, 3, 2}, {1, 1, 1}, {0.1, 1, 1}}) {
        const double volume = 4 * pi / 3 * axes[0] * axes[1] * axes[2];
        double coarse = 0;
        for (const int n : {10, 20}) {
            const Surface<3> ellipsoid = ellipsoid_body<3>(centre, axes, n, body);
            CHECK(largest_residual<3>(ellipsoid, centre, axes) < 1e-14 * 100);
            const double lost = 1 + enclosed(ellipsoid) / volume; // a body counts negative
            CHECK(lost > 0);
            if (n == 20) {
                CHECK(coarse / lost == Approx(4).epsilon(0.05));
            }
            coarse = lost;
        }
    }
}

TEST_CASE("triangles of an ellipsoid are more even than those of a stretched sphere") {
    const Surface<3> ellipsoid = ellipsoid_body<3>({}, {1, 3, 2}, 30, body);
    Surface<3> stretched = ellipsoid_body<3>({}, {1, 1, 1}, 30, body);
    for (Point<3>& x : stretched.points) {
        x = {x[0], 3 * x[1], 2 * x[2]};
    }
    CHECK(smallest_angle(ellipsoid) > 30);
    CHECK(smallest_angle(ellipsoid) > 1.5 * smallest_angle(stretched));
    const auto unevenness = [](const std::vector<double>& lengths) {
        return lengths.back() / lengths.front();
    };
    CHECK(unevenness(edge_lengths(ellipsoid)) < 0.7 * unevenness(edge_lengths(stretched)));
}

TEST_CASE("the divisions for a size give edges of about that size") {
    for (const Point<3>& axes : {Point<3>{1, 3, 2}, {1, 1, 1}, {5, 4, 3}}) {
        const Surface<3> ellipsoid = ellipsoid_body<3>({}, axes, ellipsoid_divisions<3>(axes, 0.2), body);
        const std::vector<double> lengths = edge_lengths(ellipsoid);
        CHECK(lengths[lengths.size() / 2] == Approx(0.2).epsilon(0.15));
        const Point<2> in_plane{axes[0], axes[1]};
        const Surface<2> ellipse =
            ellipsoid_body<2>({}, in_plane, ellipsoid_divisions<2>(in_plane, 0.2), body);
        CHECK(edge_lengths(ellipse).back() == Approx(0.2).epsilon(0.03));
    }
    CHECK(ellipsoid_divisions<2>({1, 1}, 100) == 3);
    CHECK(ellipsoid_divisions<3>({1, 1, 1}, 100) == 1);
    CHECK_THROWS_AS(ellipsoid_divisions<3>({1, 1, 1}, 0), UsageError);
    CHECK_THROWS_AS(ellipsoid_divisions<3>({1, 1, 1}, 1e-300), LimitError);
}

TEST_CASE("bodies without extent or with too few divisions are refused") {
    CHECK_THROWS_AS(ellipsoid_body<2>({}, {1, 1}, 2, body), UsageError);
    CHECK_THROWS_AS(ellipsoid_body<3>({}, {1, 1, 1}, 0, body), UsageError);
    CHECK_THROWS_AS(ellipsoid_body<3>({}, {1, 1, 1}, std::numeric_limits<int>::max(), body), UsageError);
    CHECK_THROWS_AS(ellipsoid_body<3>({}, {1, 0, 1}, 5, body), UsageError);
    CHECK_THROWS_AS(ellipsoid_body<2>({std::nan(""), 0}, {1, 1}, 5, body), UsageError);
}

TEST_CASE("a box and a body in it join to the boundary of the domain between them") {
    const Surface<3> box = box_surface<3>({-5, -5, -5}, {5, 5, 5}, 1, walls);
    const Surface<3> ellipsoid = ellipsoid_body<3>({}, {1, 3, 2}, 6, body);
    const Surface<3> domain = join<3>(std::vector{box, ellipsoid});
    CHECK(is_closed(domain));
    CHECK(euler_characteristic(domain) == 4);
    CHECK(enclosed(domain) == Approx(enclosed(box) + enclosed(ellipsoid)));
    CHECK(enclosed(domain) < 1000);
    CHECK(domain.patches == PatchList{body, walls}); // by number
    CHECK(domain.patch.front() == 7);
    CHECK(domain.patch.back() == 3);
}

TEST_CASE("joining keeps points and facets in order") {
    const Surface<2> first = box_surface<2>({0, 0}, {1, 1}, 1, walls);
    const Surface<2> second = box_surface<2>({2, 0}, {3, 1}, 1, walls);
    const Surface<2> both = join<2>(std::vector{first, second});
    REQUIRE(both.facets.size() == 8);
    CHECK(both.points[5] == second.points[1]);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(both.facets[6][i] == second.facets[2][i] + 4);
    }
    CHECK(both.patches == PatchList{walls});
    CHECK(join<2>({}).facets.empty());
}

TEST_CASE("a patch number with two names and a name with two numbers are refused") {
    const Surface<2> first = box_surface<2>({0, 0}, {1, 1}, 1, walls);
    const Surface<2> renamed = box_surface<2>({2, 0}, {3, 1}, 1, {7, "others"});
    const Surface<2> renumbered = box_surface<2>({2, 0}, {3, 1}, 1, {8, "walls"});
    CHECK_THROWS_WITH(join<2>(std::vector{first, renamed}), Catch::Contains("\"others\""));
    CHECK_THROWS_WITH(join<2>(std::vector{first, renumbered}), Catch::Contains("7 and 8"));
}
