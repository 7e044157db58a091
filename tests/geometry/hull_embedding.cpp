// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/hull_embedding.h"

#include "core/rounds.h"
#include "simplex_judge.h"
#include "specimens.h"

#include "slabhull/geometry/measures.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

using namespace slabhull;

namespace {

/// Two D-simplices of a soup.
template<int D>
struct Pair {
    Array<Point<D + 1>> points;
    Simplex<D> first;
    Simplex<D> second;

    std::array<Simplex<D>, 2> cells() const { return {first, second}; }
    bool judged() const { return tests::SimplexJudge<D>{points, first, second}.meet_elsewhere(); }
};

template<int D>
std::vector<Crossing<D + 1>> crossings_of(const Pair<D>& pair) {
    const auto cells = pair.cells();
    const auto adjacency = build_adjacency<D>(cells, pair.points.size());
    return examine_embedding<D>(pair.points, cells, adjacency).crossings;
}

template<int D>
bool cross(const Pair<D>& pair) {
    return !crossings_of(pair).empty();
}

/// How the coordinates of a family of pairs are drawn.
struct Family {
    const char* name;
    int reach;          ///< whole coordinates up to this size
    int flat = -1;      ///< axis along which all are 0
    bool apart = false; ///< the second simplex only has coordinates of 0 or more along axis 0, the first only
                        ///< of 0 or less
};

template<int D>
class RandomPairs {
public:
    RandomPairs(const Family& family, std::size_t shared, unsigned seed)
        : family_{family}, shared_{shared}, random_{seed} {}

    /// The next pair of simplices that have extent.
    Pair<D> next() {
        for (;;) {
            Pair<D> pair = draw();
            if (has_extent(pair.first, pair) && has_extent(pair.second, pair)) {
                return pair;
            }
        }
    }

private:
    Pair<D> draw() {
        Pair<D> pair;
        for (std::size_t i = 0; i <= D; ++i) {
            pair.first[i] = add(-1, i < shared_, pair);
        }
        for (std::size_t i = 0; i <= D; ++i) {
            pair.second[i] = i < shared_ ? pair.first[i] : add(1, false, pair);
        }
        std::shuffle(pair.first.begin(), pair.first.end(), random_);
        std::shuffle(pair.second.begin(), pair.second.end(), random_);
        return pair;
    }

    Index add(int side, bool shared, Pair<D>& pair) {
        Point<D + 1> p{};
        for (std::size_t k = 0; k <= D; ++k) {
            const auto width = static_cast<unsigned>(2 * family_.reach + 1);
            p[k] =
                static_cast<int>(k) == family_.flat ? 0 : static_cast<int>(random_() % width) - family_.reach;
        }
        if (family_.apart) {
            p[0] = shared ? 0 : side * std::abs(p[0]);
        }
        pair.points.push_back(p);
        return static_cast<Index>(pair.points.size() - 1);
    }

    static bool has_extent(const Simplex<D>& cell, const Pair<D>& pair) {
        const Point<D + 1> normal = simplex_normal<D>(corners_of<D, D + 1>(cell, pair.points));
        return std::any_of(normal.begin(), normal.end(), [](double x) { return std::abs(x) > 1e-6; });
    }

    Family family_;
    std::size_t shared_;
    std::mt19937 random_;
};

template<int D>
void for_each_pair(int of_each, unsigned seed, const std::function<void(const Pair<D>&)>& visit) {
    for (const Family& family :
         {Family{"dense", 1}, Family{"close", 3}, Family{"far", 40}, Family{"in one instant", 3, D},
          Family{"in one wall", 3, 0}, Family{"touching along a hyperplane", 2, -1, true}}) {
        for (std::size_t shared = 0; shared <= D; ++shared) {
            CAPTURE(family.name, shared);
            RandomPairs<D> pairs{family, shared, seed};
            for (int k = 0; k < rounds(of_each); ++k) {
                visit(pairs.next());
            }
        }
    }
}

template<int D>
Pair<D> moved(Pair<D> pair, const std::function<Point<D + 1>(const Point<D + 1>&)>& map) {
    std::transform(pair.points.begin(), pair.points.end(), pair.points.begin(), map);
    return pair;
}

double dot(const Point<4>& a, const Point<4>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Whether p is in a tetrahedron, to rounding: in its hyperplane, and no barycentric coordinate is negative.
bool is_in(const Point<4>& p, const Simplex<3>& cell, const Array<Point<4>>& points) {
    const auto corners = corners_of<3, 4>(cell, points);
    const Point<4> normal = simplex_normal<3>(corners);
    Point<4> from_corner;
    std::transform(p.begin(), p.end(), corners[0].begin(), from_corner.begin(), std::minus{});
    bool inside = std::abs(dot(from_corner, normal)) < 1e-9 * dot(normal, normal);
    for (std::size_t i = 0; i < 4; ++i) {
        auto replaced = corners;
        replaced[i] = p;
        inside = inside && dot(simplex_normal<3>(replaced), normal) > -1e-9 * dot(normal, normal);
    }
    return inside;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("pairs of simplices cross exactly when a judge in whole numbers says so",
                       "[embedding]", ((int D), D), 2, 3) {
    std::size_t crossing = 0;
    std::size_t all = 0;
    for_each_pair<D>(250, 7, [&](const Pair<D>& pair) {
        const bool judged = pair.judged();
        REQUIRE(cross(pair) == judged);
        crossing += judged;
        ++all;
    });
    CHECK(crossing > all / 20); // the families hold both kinds
    CHECK(crossing < all * 19 / 20);
}

TEMPLATE_TEST_CASE_SIG("what crosses does not depend on how it is told or where it is", "[embedding]",
                       ((int D), D), 2, 3) {
    std::mt19937 random{3};
    for_each_pair<D>(60, 11, [&](const Pair<D>& pair) {
        const bool expected = cross(pair);
        REQUIRE(cross(Pair<D>{pair.points, pair.second, pair.first}) == expected);
        Pair<D> permuted = pair;
        std::shuffle(permuted.first.begin(), permuted.first.end(), random);
        std::shuffle(permuted.second.begin(), permuted.second.end(), random);
        REQUIRE(cross(permuted) == expected);
        for (std::size_t axis = 0; axis <= D; ++axis) {
            REQUIRE(cross(moved<D>(pair, [&](Point<D + 1> p) { // mirrored
                        p[axis] = -p[axis];
                        return p;
                    })) == expected);
            REQUIRE(cross(moved<D>(pair, [&](Point<D + 1> p) { // another unit, far away
                        p[axis] = std::ldexp(p[axis] + 1000000, -40);
                        return p;
                    })) == expected);
            REQUIRE(cross(moved<D>(pair, [&](Point<D + 1> p) { // sheared: hyperplanes are oblique now
                        p[axis] += 3 * p[(axis + 1) % (D + 1)] - 5 * p[(axis + 2) % (D + 1)];
                        return p;
                    })) == expected);
        }
    });
}

TEST_CASE("a crossing of tetrahedra is reported at a point of both", "[embedding]") {
    for_each_pair<3>(200, 5, [](const Pair<3>& pair) {
        for (const Crossing<4>& crossing : crossings_of(pair)) {
            REQUIRE(is_in(crossing.near, pair.first, pair.points));
            REQUIRE(is_in(crossing.near, pair.second, pair.points));
        }
    });
}

TEST_CASE("cones over triangles in space cross when the triangles do", "[embedding]") {
    for_each_pair<2>(100, 13, [](const Pair<2>& pair) {
        Surface<3> surface;
        surface.points = pair.points;
        surface.facets = {pair.first, pair.second};
        specimens::name_patch(surface, 1, "pair");
        const bool expected = !find_crossings<3>(surface).empty();
        REQUIRE(cross(pair) == expected);
        Pair<3> cones;
        for (const Point<3>& p : pair.points) {
            cones.points.push_back({p[0], p[1], p[2], 0});
        }
        const auto apex = static_cast<Index>(cones.points.size());
        cones.points.push_back({2, 1, -3, 1});
        std::copy(pair.first.begin(), pair.first.end(), cones.first.begin());
        std::copy(pair.second.begin(), pair.second.end(), cones.second.begin());
        cones.first[3] = apex;
        cones.second[3] = apex;
        REQUIRE(cross(cones) == expected);
        cones.second[3] = apex + 1; // and with tips of their own on the two sides of space, in touch there
        cones.points.push_back({-1, 4, 2, -1});
        REQUIRE(cross(cones) == expected);
    });
}

TEST_CASE("a gap of one part in 10^15 is a gap, and closing it is a crossing", "[embedding]") {
    const auto tilted = [](double gap) {
        Pair<3> pair;
        pair.points = {{0, 0, 0, 0},         {1, 0, 0, 0}, {0, 1, 0, 0},   {0, 0, 1, 0}, //
                       {0.1, 0.2, 0.3, gap}, {1, 0, 0, 1}, {0, 1, 0, 1.5}, {0, 0, 1, 2}};
        pair.first = {0, 1, 2, 3};
        pair.second = {4, 5, 6, 7};
        return pair;
    };
    CHECK_FALSE(cross(tilted(1e-15)));
    CHECK_FALSE(cross(tilted(1e-300)));
    CHECK(cross(tilted(0)));
    CHECK(cross(tilted(-1e-300)));
}

TEST_CASE("cells without extent are named alone, cells on the same vertices as a pair", "[embedding]") {
    Pair<3> pair;
    pair.points = {{0, 0, 0, 0}, {1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3},
                   {3, 3, 3, 3}, {3, 4, 3, 3}, {4, 3, 3, 3}, {5, 5, 3, 3}};
    pair.first = {0, 1, 2, 3};
    pair.second = {4, 5, 6, 7};
    const auto flat = crossings_of(pair);
    REQUIRE(flat.size() == 1);
    CHECK(flat[0].first == 1);
    CHECK(flat[0].second == 1);
    pair.second = {3, 1, 0, 2};
    const auto same = crossings_of(pair);
    REQUIRE(same.size() == 1);
    CHECK(same[0].first == 0);
    CHECK(same[0].second == 1);
}

TEST_CASE("no more crossings are listed than asked for", "[embedding]") {
    Array<Point<4>> points;
    std::vector<Simplex<3>> cells;
    for (Index k = 0; k < 10; ++k) { // all around the origin
        const double s = 1 + 0.1 * k;
        for (const Point<4>& p :
             {Point<4>{-s, -1, -1, k * 0.01}, {s, -1, -1, k * 0.02}, {0, s, -1, -k * 0.03}, {0, 0, s, 0}}) {
            points.push_back(p);
        }
        cells.push_back({4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3});
    }
    const auto adjacency = build_adjacency<3>(cells, points.size());
    const auto all = examine_embedding<3>(points, cells, adjacency, 100);
    CHECK(all.all_listed);
    const auto some = examine_embedding<3>(points, cells, adjacency, 7);
    CHECK(some.crossings.size() == 7);
    CHECK_FALSE(some.all_listed);
    CHECK(all.crossings.size() > 7);
    CHECK(std::is_sorted(all.crossings.begin(), all.crossings.end(), [](const auto& a, const auto& b) {
        return std::pair{a.first, a.second} < std::pair{b.first, b.second};
    }));
    CHECK(examine_embedding<3>(points, {}, build_adjacency<3>({}, points.size())).crossings.empty());
}
