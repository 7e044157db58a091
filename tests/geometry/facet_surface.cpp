// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/facet_surface.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

template<int D>
Surface<D> ball(int divisions) {
    Point<D> axes;
    axes.fill(1);
    return ellipsoid_body<D>({}, axes, divisions, {1, "body"});
}

template<int D>
Surface<D> unit_box(double size) {
    Point<D> low;
    Point<D> high;
    low.fill(0);
    high.fill(1);
    return box_surface<D>(low, high, size, {1, "box"});
}

/// Facets of all sizes that cross and overlap, needles among them, and some that are edges or points.
template<int D>
Surface<D> rubble(std::size_t count) {
    Surface<D> soup;
    const auto centres = random_points<D>(count, 1, 5);
    const auto arms = random_points<D>(count * D, 1, 6);
    for (std::size_t f = 0; f < count; ++f) {
        Facet<D> facet;
        for (std::size_t i = 0; i < D; ++i) {
            const double reach = f % 5 == 0 && i > 0 ? 0 : std::ldexp(1.0, -static_cast<int>(f % 12));
            Point<D> corner = centres[f];
            for (std::size_t k = 0; k < D; ++k) {
                const Point<D>& arm = arms[f * D + (f % 3 == 0 && i == 2 ? 1 : i)]; // some are edges
                const double needle = f % 7 == 0 && i == 2 ? 1e-7 * static_cast<double>(k) : 0;
                corner[k] += reach * (arm[k] + needle);
            }
            facet[i] = static_cast<Index>(soup.points.size());
            soup.points.push_back(corner);
        }
        soup.facets.push_back(facet);
    }
    return soup;
}

/// Brute force by another way: the best of the point where the gradient vanishes, taken from the normal
/// equations, and the rims. In quadruple precision, since the normal equations of a needle lose most digits.
namespace brute {

__extension__ using Quad = __float128;

template<int D>
using Long = std::array<Quad, D>;

template<int D>
Long<D> lengthen(const Point<D>& x) {
    Long<D> longer;
    std::copy(x.begin(), x.end(), longer.begin());
    return longer;
}

template<int D>
Quad dot(const Long<D>& a, const Long<D>& b) {
    Quad sum = 0;
    for (std::size_t k = 0; k < D; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

template<int D>
Long<D> along(const Long<D>& a, Quad t, const Long<D>& b) {
    Long<D> sum;
    for (std::size_t k = 0; k < D; ++k) {
        sum[k] = a[k] + t * b[k];
    }
    return sum;
}

template<int D>
long double apart(const Long<D>& a, const Long<D>& b) {
    const Long<D> arm = along<D>(a, -1, b);
    return std::sqrt(static_cast<long double>(dot<D>(arm, arm)));
}

template<int D>
Long<D> on_segment(const Long<D>& x, const Long<D>& a, const Long<D>& b) {
    const Long<D> edge = along<D>(b, -1, a);
    const Quad square = dot<D>(edge, edge);
    const Quad t = square > 0 ? dot<D>(along<D>(x, -1, a), edge) / square : 0;
    return along<D>(a, std::clamp<Quad>(t, 0, 1), edge);
}

Long<2> on_facet(const Long<2>& x, const std::array<Long<2>, 2>& c) {
    return on_segment<2>(x, c[0], c[1]);
}

Long<3> on_facet(const Long<3>& x, const std::array<Long<3>, 3>& c) {
    const Long<3> p = along<3>(c[1], -1, c[0]);
    const Long<3> q = along<3>(c[2], -1, c[0]);
    const Long<3> arm = along<3>(x, -1, c[0]);
    const Quad pp = dot<3>(p, p), pq = dot<3>(p, q), qq = dot<3>(q, q);
    const Quad determinant = pp * qq - pq * pq;
    Long<3> best = on_segment<3>(x, c[0], c[1]);
    const auto try_point = [&](const Long<3>& y) {
        if (apart<3>(x, y) < apart<3>(x, best)) {
            best = y;
        }
    };
    try_point(on_segment<3>(x, c[1], c[2]));
    try_point(on_segment<3>(x, c[2], c[0]));
    if (determinant > 1e-25L * pp * qq) {
        const Quad s = (qq * dot<3>(p, arm) - pq * dot<3>(q, arm)) / determinant;
        const Quad t = (pp * dot<3>(q, arm) - pq * dot<3>(p, arm)) / determinant;
        if (s > 0 && t > 0 && s + t < 1) {
            try_point(along<3>(along<3>(c[0], s, p), t, q));
        }
    }
    return best;
}

template<int D>
struct Nearest {
    Long<D> point;
    long double distance;
    long double runner_up; ///< least distance of a facet whose closest point is elsewhere
};

template<int D>
Nearest<D> closest(const Surface<D>& surface, const Point<D>& from) {
    const Long<D> x = lengthen<D>(from);
    std::vector<Long<D>> feet;
    for (const Facet<D>& facet : surface.facets) {
        std::array<Long<D>, D> corners;
        std::transform(facet.begin(), facet.end(), corners.begin(),
                       [&surface](Index v) { return lengthen<D>(surface.points[v]); });
        feet.push_back(on_facet(x, corners));
    }
    const auto nearer = [&x](const Long<D>& a, const Long<D>& b) { return apart<D>(x, a) < apart<D>(x, b); };
    const Long<D> best = *std::min_element(feet.begin(), feet.end(), nearer);
    Nearest<D> found{best, apart<D>(x, best), std::numeric_limits<double>::infinity()};
    for (const Long<D>& foot : feet) {
        if (apart<D>(foot, best) > 1e-14L) {
            found.runner_up = std::min(found.runner_up, apart<D>(x, foot));
        }
    }
    return found;
}

} // namespace brute

/// Points on, near and far from the facets, near their corners, and on the medial axis of ball and box.
template<int D>
std::vector<Point<D>> queries(const Surface<D>& surface) {
    std::vector<Point<D>> all{Point<D>{}};
    for (const double reach : {0.2, 1.5, 1000.0}) {
        const auto more = random_points<D>(50, reach, 7);
        all.insert(all.end(), more.begin(), more.end());
    }
    const auto steps = random_points<D>(50, 1, 8);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Facet<D>& facet = surface.facets[i * 7919 % surface.facets.size()];
        for (const double reach : {0.0, 1e-12, 1e-5, 0.01}) {
            Point<D> middle{};
            Point<D> corner = surface.points[facet[0]];
            for (std::size_t k = 0; k < D; ++k) {
                for (const Index v : facet) {
                    middle[k] += surface.points[v][k] / D;
                }
                middle[k] += reach * steps[i][k];
                corner[k] += reach * steps[i][k];
            }
            all.push_back(middle);
            all.push_back(corner);
        }
        Point<D> diagonal; // of the box
        diagonal.fill(0.5 * (steps[i][0] + 1));
        all.push_back(diagonal);
        diagonal[0] = 0.5;
        all.push_back(diagonal);
    }
    return all;
}

template<int D>
void require_closest(const Surface<D>& surface) {
    const auto projected = facet_surface<D>(surface);
    for (const Point<D>& x : queries<D>(surface)) {
        const Point<D> y = projected->closest(x);
        const auto best = brute::closest<D>(surface, x);
        const double size = 2 + distance(x, Point<D>{});
        CAPTURE(x, y, static_cast<double>(best.distance));
        REQUIRE(distance(x, y) <= static_cast<double>(best.distance) + 1e-15 * size);
        REQUIRE(static_cast<double>(brute::closest<D>(surface, y).distance) < 1e-15 * size);
        if (best.runner_up > best.distance + 1e-14L * size) {
            REQUIRE(static_cast<double>(brute::apart<D>(brute::lengthen<D>(y), best.point)) < 1e-14 * size);
        }
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the closest point of facets is that of brute force, near, far and on the medial axis",
                       "", ((int D), D), 2, 3) {
    require_closest<D>(ball<D>(D == 3 ? 6 : 200));
    require_closest<D>(unit_box<D>(0.25));
    require_closest<D>(rubble<D>(300));
    require_closest<D>(rubble<D>(1));
}

TEMPLATE_TEST_CASE_SIG("points on facets hardly move", "", ((int D), D), 2, 3) {
    const Surface<D> surface = ball<D>(D == 3 ? 12 : 200);
    const auto projected = facet_surface<D>(surface);
    for (const Point<D>& corner : surface.points) {
        CHECK(projected->closest(corner) == corner);
    }
    std::vector<Point<D>> once = random_points<D>(2000, 2);
    project<D>(*projected, {}, once);
    std::vector<Point<D>> twice = once;
    CHECK(project<D>(*projected, {}, twice).largest < 4e-16);
}

TEST_CASE("of facets that are equally near, one with its closest point inside counts, then the first") {
    const auto box = facet_surface<2>(unit_box<2>(1));
    CHECK(box->closest({0.5, 0.5}) == box->closest({0.5, 0.5}));
    Surface<2> sides;
    sides.points = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    sides.facets = {{1, 2}, {3, 0}, {0, 1}, {2, 3}};
    CHECK(facet_surface<2>(sides)->closest({0, 0}) == Point<2>{0, 1});
    std::reverse(sides.facets.begin(), sides.facets.end());
    CHECK(facet_surface<2>(sides)->closest({0, 0}) == Point<2>{-1, 0});
    sides.points = {{1, 0}, {1, 1}, {-1, 1}, {0, -1}};
    sides.facets = {{0, 1}, {2, 3}, {3, 0}};
    CHECK(facet_surface<2>(sides)->closest({-1, -1})[0] < 0);
}

TEST_CASE("facets without extent are the edges and points that they are") {
    Surface<3> surface;
    surface.points = {{0, 0, 0}, {1, 0, 0}, {0.25, 0, 0}, {5, 5, 5}};
    surface.facets = {{0, 1, 2}, {3, 3, 3}};
    const auto degenerate = facet_surface<3>(surface);
    CHECK(degenerate->closest({0.5, 1, 0}) == Point<3>{0.5, 0, 0});
    CHECK(degenerate->closest({9, 1, 5}) == Point<3>{5, 5, 5});
}

TEST_CASE("facet surfaces give the same bits for any number of threads") {
    const auto surface = facet_surface<3>(ball<3>(10));
    std::vector<Point<3>> one = random_points<3>(20'000, 2);
    std::vector<Point<3>> many = one;
    set_thread_count(1);
    project<3>(*surface, {}, one);
    set_thread_count(5);
    project<3>(*surface, {}, many);
    set_thread_count(0);
    CHECK(one == many);
}

TEST_CASE("no facets, and corners that are no points, are refused; no point is closest to none") {
    CHECK_THROWS_AS(facet_surface<3>({}), UsageError);
    Surface<2> surface;
    surface.points = {{0, 0}, {1, 0}, {2, std::nan("")}};
    surface.facets = {{0, 1}, {1, 2}};
    try {
        facet_surface<2>(surface);
        FAIL("accepted");
    } catch (const GeometryError& error) {
        REQUIRE(error.entities.size() == 1);
        CHECK(error.entities[0].number == 1);
    }
    std::vector<Point<3>> x{{0, 0, std::numeric_limits<double>::infinity()}};
    CHECK_THROWS_AS(project<3>(*facet_surface<3>(ball<3>(1)), {}, x), GeometryError);
}

TEST_CASE("points of a crease between two facet surfaces, or one of facets and a plane, end on both") {
    // A tube of 64 sides about z, open at its end z = 1, where its lid is.
    constexpr int sides = 64;
    Surface<3> tube;
    Surface<3> lid;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        tube.points.push_back({std::cos(angle), std::sin(angle), 0});
        tube.points.push_back({std::cos(angle), std::sin(angle), 1});
        const auto a = static_cast<Index>(2 * i);
        const auto b = static_cast<Index>(2 * ((i + 1) % sides));
        tube.facets.push_back({a, b, a + 1});
        tube.facets.push_back({a + 1, b, b + 1});
        lid.facets.push_back({a + 1, b + 1, 2 * sides});
    }
    lid.points = tube.points;
    lid.points.push_back({0, 0, 1});
    const auto wall = facet_surface<3>(tube);
    for (const auto& end : {facet_surface<3>(lid), plane_surface<3>({0, 0, 1}, {0, 0, 1})}) {
        const std::vector<PlacedSurface<3>> both{{wall.get(), {}}, {end.get(), {}}};
        for (const Point<3>& away : random_points<3>(500, 0.02)) {
            std::vector<Point<3>> x{{0.6 + away[0], 0.8 + away[1], 1 + away[2]}};
            std::vector<double> moved(1);
            project_onto_all<3>(both, x, 1, moved);
            CHECK(x[0][2] == Approx(1).margin(1e-15));
            CHECK(distance(wall->closest(x[0]), x[0]) < 1e-14);
            CHECK(moved[0] < 0.06);
        }
    }
}

TEST_CASE("surfaces that leave a gap within their tolerance meet") {
    Surface<2> left;
    left.points = {{-1, 0}, {-1e-7, 0}};
    left.facets = {{0, 1}};
    Surface<2> right;
    right.points = {{0, 0}, {0, -1}};
    right.facets = {{0, 1}};
    for (const double tolerance : {0.0, 1e-7}) {
        const auto floor = facet_surface<2>(left, tolerance);
        const auto wall = facet_surface<2>(right);
        const std::vector<PlacedSurface<2>> both{{floor.get(), {}}, {wall.get(), {}}};
        std::vector<Point<2>> x{{0.01, 0.01}};
        if (tolerance == 0) {
            CHECK_THROWS_AS(project_onto_all<2>(both, x, 1), GeometryError);
        } else {
            project_onto_all<2>(both, x, 1);
            CHECK(distance(x[0], Point<2>{0, 0}) < 2e-7);
        }
    }
}
