// SPDX-License-Identifier: BSD-3-Clause
#include "specimens.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/embedding.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace slabhull;
using namespace slabhull::specimens;
using Catch::Matchers::Contains;

namespace {

// --- A slow judge in whole numbers
// ------------------------------------------------------------------------------

using Vec = std::array<std::int64_t, 3>;
using Hull = std::vector<Vec>; ///< the convex hull of up to three points

Vec minus(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
std::int64_t dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool separates(const Vec& direction, const Hull& a, const Hull& b) {
    const auto range = [&](const Hull& hull) {
        std::pair<std::int64_t, std::int64_t> r{INT64_MAX, INT64_MIN};
        for (const Vec& p : hull) {
            r = {std::min(r.first, dot(direction, p)), std::max(r.second, dot(direction, p))};
        }
        return r;
    };
    return range(a).second < range(b).first || range(b).second < range(a).first;
}

/// Two convex sets are apart when some direction tells them apart: one of finitely many, made from their
/// edges.
bool sets_meet(const Hull& a, const Hull& b) {
    std::vector<Vec> edges{minus(a[0], b[0])};
    for (const Hull* hull : {&a, &b}) {
        for (std::size_t i = 0; i < hull->size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                edges.push_back(minus((*hull)[i], (*hull)[j]));
            }
        }
    }
    for (const Vec& e : edges) {
        for (const Vec& f : edges) {
            for (const Vec& g : edges) {
                if (separates(e, a, b) || separates(cross(e, f), a, b) ||
                    separates(cross(cross(e, f), g), a, b)) {
                    return false;
                }
            }
        }
    }
    return true;
}

Vec whole(const Point<2>& p) {
    return {std::lround(p[0]), std::lround(p[1]), 0};
}
Vec whole(const Point<3>& p) {
    return {std::lround(p[0]), std::lround(p[1]), std::lround(p[2])};
}

template<int D, std::size_t N>
Hull corners(const Surface<D>& s, const std::array<Index, N>& facet) {
    Hull hull;
    for (const Index v : facet) {
        hull.push_back(whole(s.points[v]));
    }
    return hull;
}

bool flat(const Hull& h) {
    return h.size() == 2 ? h[0] == h[1] : cross(minus(h[1], h[0]), minus(h[2], h[0])) == Vec{};
}

template<int D>
bool slow_crossing(const Surface<D>& s, Facet<D> f, Facet<D> g) {
    const auto is_shared = [](const Facet<D>& other) {
        return [&other](Index v) { return std::count(other.begin(), other.end(), v) > 0; };
    };
    const Facet<D> old_f = f;
    const auto shared = std::stable_partition(f.begin(), f.end(), is_shared(g)) - f.begin();
    std::stable_partition(g.begin(), g.end(), is_shared(old_f));
    const Hull a = corners(s, f);
    const Hull b = corners(s, g);
    if (shared == 0 || shared == D) {
        return shared == D || sets_meet(a, b);
    }
    if (shared == 1) {
        return sets_meet(Hull(a.begin() + 1, a.end()), b) || sets_meet(a, Hull(b.begin() + 1, b.end()));
    }
    const Vec edge = minus(a[1], a[0]);
    const Vec normal = cross(edge, minus(a[2], a[0]));
    return dot(normal, minus(b[2], a[0])) == 0 && dot(normal, cross(edge, minus(b[2], a[0]))) > 0;
}

using Pairs = std::vector<std::pair<Index, Index>>;

template<int D>
Pairs slow_crossings(const Surface<D>& s) {
    Pairs pairs;
    for (Index f = 0; f < s.facets.size(); ++f) {
        if (flat(corners(s, s.facets[f]))) {
            pairs.emplace_back(f, f);
            continue;
        }
        for (Index g = f + 1; g < s.facets.size(); ++g) {
            if (!flat(corners(s, s.facets[g])) && slow_crossing<D>(s, s.facets[f], s.facets[g])) {
                pairs.emplace_back(f, g);
            }
        }
    }
    return pairs;
}

template<int D>
Pairs crossings(const Surface<D>& s) {
    Pairs pairs;
    for (const Crossing<D>& c : find_crossings(s, 1'000'000)) {
        pairs.emplace_back(c.first, c.second);
    }
    return pairs;
}

/// Facets between random points of a small grid: all kinds of touching and degeneracy come up.
template<int D>
Surface<D> random_soup(unsigned seed, Index points, Index facets, int width) {
    std::mt19937 random{seed};
    const auto below = [&](std::uint32_t n) { return static_cast<Index>(random() % n); };
    Surface<D> s;
    for (Index v = 0; v < points; ++v) {
        Point<D> p;
        for (double& x : p) {
            x = static_cast<double>(below(static_cast<std::uint32_t>(width)));
        }
        s.points.push_back(p);
    }
    for (Index f = 0; f < facets; ++f) {
        Facet<D> facet;
        for (Index& v : facet) {
            v = below(points);
        }
        s.facets.push_back(facet);
    }
    return s;
}

/// A room: the outer boundary first, then the bodies.
template<int D>
Surface<D> room(Surface<D> outer, const Surface<D>& body) {
    return together(std::move(outer), turned_inside_out(body));
}

template<int D>
std::string complaint(const Surface<D>& surface, const FacetNaming& naming = {}) {
    try {
        require_domain_boundary(surface, naming, false);
    } catch (const GeometryError& error) {
        return error.what();
    }
    return "";
}

Surface<3> cone_on(double tip, double base, Index n) {
    Surface<3> s;
    s.points = {{0, 0, tip}, {0, 0, base}};
    for (Index i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        s.points.push_back({std::cos(angle), std::sin(angle), base});
        const Index a = 2 + i;
        const Index b = 2 + (i + 1) % n;
        s.facets.push_back({0, a, b});
        s.facets.push_back({1, b, a});
    }
    name_patch(s, 4, "cone");
    return tip > base ? s : turned_inside_out(s);
}

/// Two cones that share the vertex at their tips.
Surface<3> hourglass() {
    Surface<3> s = together(cone_on(0, -1, 8), cone_on(0, 1, 8));
    const Index other_tip = 10;
    for (Facet<3>& facet : s.facets) {
        for (Index& v : facet) {
            v = v == other_tip ? 0 : v - (v > other_tip ? 1 : 0);
        }
    }
    s.points.erase(s.points.begin() + other_tip);
    return s;
}

Surface<3> moebius_band(Index n) {
    Surface<3> s;
    for (Index i = 0; i < n; ++i) {
        const double u = 2 * std::numbers::pi * i / n;
        for (const double v : {-0.3, 0.3}) {
            const double r = 2 + v * std::cos(u / 2);
            s.points.push_back({r * std::cos(u), r * std::sin(u), v * std::sin(u / 2)});
        }
        const Index a = 2 * i;
        const Index b = a + 1;
        const Index c = i + 1 < n ? a + 2 : 1; // the ends are joined crosswise
        const Index d = i + 1 < n ? a + 3 : 0;
        s.facets.push_back({a, c, d});
        s.facets.push_back({a, d, b});
    }
    name_patch(s, 5, "band");
    return s;
}

struct Threads {
    explicit Threads(int count) { set_thread_count(count); }
    ~Threads() { set_thread_count(0); }
};

} // namespace

// --- Crossings
// ---------------------------------------------------------------------------------------------------

TEMPLATE_TEST_CASE_SIG("crossings are those that comparing every pair in whole numbers finds", "[crossings]",
                       ((int D), D), 2, 3) {
    std::size_t found = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        INFO("seed " << seed);
        const Surface<D> dense = random_soup<D>(seed, 14, 20, 3);
        const Surface<D> middling = random_soup<D>(seed, 40, 30, 8);
        const Surface<D> sparse = random_soup<D>(seed, 90, 30, 1000);
        for (const Surface<D>* soup : {&dense, &middling, &sparse}) {
            const Pairs expected = slow_crossings(*soup);
            found += expected.size();
            REQUIRE(crossings(*soup) == expected);
        }
    }
    CHECK(found > 1000);
}

TEMPLATE_TEST_CASE_SIG("crossings do not depend on vertex order, mirroring, scale or the numbering of facets",
                       "[crossings]", ((int D), D), 2, 3) {
    for (unsigned seed = 100; seed < 110; ++seed) {
        const Surface<D> soup = random_soup<D>(seed, 40, 60, 6);
        const Pairs expected = crossings(soup);

        Surface<D> turned = soup;
        for (Facet<D>& facet : turned.facets) {
            std::rotate(facet.begin(), facet.begin() + 1, facet.end());
        }
        CHECK(crossings(turned) == expected);
        CHECK(crossings(turned_inside_out(soup)) == expected);
        const auto mirrored = mapped(soup, [](Point<D> p) {
            std::swap(p[0], p[D - 1]);
            p[1] = -p[1];
            return p;
        });
        CHECK(crossings(mirrored) == expected);
        CHECK(crossings(mapped(soup, [](Point<D> p) {
                  for (double& x : p) {
                      x = std::ldexp(x, -300);
                  }
                  return p;
              })) == expected);

        Surface<D> backwards = soup;
        std::reverse(backwards.facets.begin(), backwards.facets.end());
        const auto last = static_cast<Index>(soup.facets.size() - 1);
        Pairs renumbered;
        for (const auto& [first, second] : crossings(backwards)) {
            renumbered.emplace_back(last - second, last - first);
        }
        std::sort(renumbered.begin(), renumbered.end());
        CHECK(renumbered == expected);
    }
}

TEST_CASE("crossings are the same with any number of threads, and a limit keeps some of them",
          "[crossings]") {
    const Surface<3> soup =
        together(random_soup<3>(1, 300, 300, 100), shifted(torus(50, 8, 120, 60), {50, 50, 50}));
    const auto with = [&](int threads, std::size_t limit) {
        const Threads set{threads};
        Pairs pairs;
        for (const Crossing<3>& c : find_crossings(soup, limit)) {
            pairs.emplace_back(c.first, c.second);
        }
        return pairs;
    };
    const Pairs all = with(1, 100'000'000);
    CHECK(all == with(2, 100'000'000));
    CHECK(all == with(3, 100'000'000));
    const Pairs some = with(1, 50);
    CHECK(some.size() == 50);
    CHECK(some == with(2, 50));
    CHECK(std::includes(all.begin(), all.end(), some.begin(), some.end()));
}

TEST_CASE("sound surfaces have no crossings, however large, flat, graded, stretched or turned",
          "[crossings]") {
    const auto tilted = [](Point<3> p) {
        const double c = std::cos(0.3);
        const double s = std::sin(0.3);
        return Point<3>{c * p[0] - s * p[1], c * (s * p[0] + c * p[1]) - s * p[2],
                        s * (s * p[0] + c * p[1]) + c * p[2]};
    };
    const std::vector<Surface<3>> sound{
        cube_grid(20),
        mapped(cube_grid(20), tilted),
        mapped(cube_grid(20),
               [](Point<3> p) {
                   return Point<3>{p[0], p[1], 1e-9 * p[2]};
               }),
        ball({1e5, 0, 0}, 1, 20),
        mapped(ball({0, 0, 0}, 1, 20),
               [](Point<3> p) {
                   return Point<3>{1000 * p[0], p[1], p[2]};
               }),
        room(box({-9, -9, -9}, {9, 9, 9}, 1), ball({0, 0, 0}, 1, 20)),
        torus(3, 1, 60, 30),
        hourglass(),
        moebius_band(20),
    };
    for (std::size_t k = 0; k < sound.size(); ++k) {
        INFO(k);
        CHECK(find_crossings(sound[k]).empty());
    }
}

TEST_CASE("the place of a crossing is near both facets", "[crossings]") {
    Surface<3> s;
    s.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 2}, {9, 9, 2}};
    s.facets = {{0, 1, 2}, {3, 4, 5}};
    const auto found = find_crossings(s);
    REQUIRE(found.size() == 1);
    CHECK(found[0].near[2] == Approx(0).margin(1e-2));
    CHECK(found[0].near[0] == Approx(found[0].near[1]).margin(1e-2));
    CHECK(found[0].near[0] + found[0].near[1] < 4.1);
}

TEST_CASE("a facet with a coordinate that is no number is reported and harms no other",
          "[crossings][bad-input]") {
    Surface<3> s = cube_grid(3);
    s.points[s.facets[0][0]][2] = std::numeric_limits<double>::quiet_NaN();
    s.points[s.facets[20][1]][0] = std::numeric_limits<double>::infinity();
    const auto found = find_crossings(s);
    CHECK(!found.empty());
    CHECK(std::all_of(found.begin(), found.end(), [](const auto& c) { return c.first == c.second; }));
}

TEST_CASE("nothing crosses in nothing", "[crossings]") {
    CHECK(find_crossings(Surface<3>{}).empty());
    CHECK(find_crossings(Surface<2>{}).empty());
}

// --- Boundaries of domains
// ----------------------------------------------------------------------------------------

TEST_CASE("boundaries of domains are accepted", "[boundary]") {
    CHECK(complaint(cube_grid(3)) == "");
    CHECK(complaint(room(cube_grid(3), ball({0, 0, 0}, 0.5, 3))) == "");
    CHECK(complaint(room(room(box({-9, -9, -9}, {9, 9, 9}, 1), torus(2, 0.5, 20, 10)),
                         ball({0, 0, 0}, 1, 4))) == "");
    CHECK(complaint(together(cube_grid(2), shifted(cube_grid(2), {3, 0, 0}))) ==
          ""); // a domain in two pieces
    const auto hollow = room(box({-9, -9, -9}, {9, 9, 9}, 1), ball({0, 0, 0}, 3, 4));
    CHECK(complaint(together(hollow, ball({0, 0, 0}, 1, 4))) == ""); // fluid inside a hollow body

    CHECK(complaint(disc({0, 0}, 2, 30)) == "");
    CHECK(complaint(room(disc({0, 0}, 2, 30), disc({0.5, 0}, 1, 20))) == "");
    CHECK(complaint(room(room(disc({0, 0}, 9, 5), disc({2, 0}, 1, 20)), disc({-2, 0}, 1, 20))) == "");
}

TEST_CASE("holes, surplus facets and wrong orientations are named", "[boundary][bad-input]") {
    FacetNaming naming{"room.msh", {}};
    for (std::int64_t k = 0; k < 12; ++k) {
        naming.numbers.push_back(100 + k);
    }
    Surface<3> s = cube_grid(1);

    SECTION("open") {
        s.facets.pop_back();
        s.patch.pop_back();
        CHECK_THAT(complaint(s, naming), Contains("room.msh: ") && Contains("open") &&
                                             Contains("(patch cube)") && Contains("3 places are faulty") &&
                                             Contains("facet 110"));
    }
    SECTION("three facets on an edge") {
        s.points.push_back({5, 5, 5});
        s.facets.push_back({s.facets[0][0], s.facets[0][1], 8});
        s.patch.push_back(1);
        CHECK_THAT(complaint(s, naming), Contains("in 3 facets instead of two"));
    }
    SECTION("one facet turned round") {
        std::swap(s.facets[4][0], s.facets[4][1]);
        CHECK_THAT(complaint(s, naming), Contains("opposite orientation") && Contains("facet 104"));
    }
    SECTION("a Moebius band") {
        CHECK_THAT(complaint(moebius_band(20)), Contains("not a closed, oriented surface"));
    }
    SECTION("many") {
        Surface<3> shreds = cube_grid(4);
        for (std::size_t k = 0; k < 20; ++k) {
            shreds.facets.erase(shreds.facets.begin() + static_cast<std::ptrdiff_t>(7 * k));
        }
        const std::string message = complaint(shreds);
        CHECK(std::count(message.begin(), message.end(), '\n') == 8);
    }
    SECTION("plane curves") {
        Surface<2> curve = disc({0, 0}, 1, 8);
        curve.facets.pop_back();
        CHECK_THAT(complaint(curve), Contains("the vertex at") && Contains("open"));
        curve = disc({0, 0}, 1, 8);
        std::swap(curve.facets[3][0], curve.facets[3][1]);
        CHECK_THAT(complaint(curve), Contains("opposite orientation"));
        curve = disc({0, 0}, 1, 8);
        for (Facet<2>& edge : curve.facets) { // a figure of eight: vertices 0 and 4 in one
            std::replace(edge.begin(), edge.end(), Index{4}, Index{0});
        }
        curve.points[4] = curve.points[7];
        curve.facets.erase(std::remove_if(curve.facets.begin(), curve.facets.end(),
                                          [](const Facet<2>& e) { return e[0] == e[1]; }),
                           curve.facets.end());
        CHECK(complaint(curve) != "");
    }
}

TEST_CASE("surfaces that touch in a vertex are refused", "[boundary][bad-input]") {
    CHECK_THAT(complaint(hourglass()), Contains("touch in one point") && Contains("(0, 0, 0)"));
    CHECK_THAT(complaint(together(cone_on(0, -1, 8), cone_on(0, 1, 8))),
               Contains("crosses or touches itself"));
}

TEST_CASE("crossing facets are named with number, patch and place", "[boundary][bad-input]") {
    const Surface<3> s = room(cube_grid(1), ball({0.9, 0, 0}, 0.5, 3));
    CHECK_THAT(complaint(s, {"at t = 0.25", {}}), Contains("at t = 0.25: ") &&
                                                      Contains("(patch cube) and facet") &&
                                                      Contains("(patch ball) cross near (1"));
    CHECK_THAT(complaint(room(disc({0, 0}, 2, 9), disc({2, 0}, 1, 9))), Contains("cross near"));
    CHECK_THROWS_AS(require_domain_boundary(s, {}, true), InputError);
    CHECK_THROWS_AS(require_domain_boundary(s, {}, false), GeometryError);
    try {
        require_domain_boundary(s, {}, true);
    } catch (const Error& error) {
        REQUIRE(error.entities.size() >= 2);
        CHECK(error.entities[0].kind == "facet");
        CHECK(std::set<std::string>{error.entities[0].patch, error.entities[1].patch} ==
              std::set<std::string>{"cube", "ball"});
    }
}

TEST_CASE("points and facets that cannot be are named", "[boundary][bad-input]") {
    Surface<3> s = cube_grid(2);
    SECTION("no facets") {
        CHECK_THAT(complaint(Surface<3>{}), Contains("no facets"));
    }
    SECTION("not a number") {
        s.points[7][0] = std::numeric_limits<double>::quiet_NaN();
        CHECK_THAT(complaint(s), Contains("vertex 7") && Contains("finite"));
    }
    SECTION("a vertex in no facet") {
        s.points.push_back({0, 0, 0});
        CHECK_THAT(complaint(s), Contains("1 of the boundary's vertices") && Contains("(0, 0, 0)"));
    }
    SECTION("a facet of a vertex that is not there") {
        s.facets[5][1] = 99;
        CHECK_THAT(complaint(s), Contains("facet 5") && Contains("vertex 99"));
    }
    SECTION("a facet without area") {
        s.facets[5][1] = s.facets[5][0];
        CHECK_THAT(complaint(s), Contains("no area") && Contains("facet 5"));
    }
    SECTION("an edge without length") {
        Surface<2> curve = disc({0, 0}, 1, 6);
        curve.points[1] = curve.points[0];
        CHECK_THAT(complaint(curve), Contains("no length") && Contains("facet 0 (patch disc)"));
    }
    SECTION("a fold") {
        s = cube_grid(1);
        s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
        s.facets = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        s.patch.resize(4);
        CHECK(complaint(s) == "");
        s.points[3][2] = 0;
        CHECK_THAT(complaint(s), Contains("cross") || Contains("no area"));
    }
}

TEMPLATE_TEST_CASE_SIG("bodies that do not lie in the domain are refused", "[boundary][bad-input]",
                       ((int D), D), 2, 3) {
    const auto sphere = [](double x, double radius) {
        if constexpr (D == 2) {
            return disc({x, 0.01}, radius, 12);
        } else {
            return ball({x, 0.01, 0.02}, radius, 3);
        }
    };
    const Surface<D> outer = sphere(0, 10);

    CHECK_THAT(complaint(room(outer, sphere(20, 1))), Contains("outside the domain"));
    CHECK_THAT(complaint(room(outer, sphere(-20, 1))), Contains("outside the domain"));
    CHECK_THAT(complaint(together(outer, sphere(0, 1))), Contains("lies inside the domain but is oriented"));
    CHECK_THAT(complaint(turned_inside_out(sphere(0, 1))), Contains("oriented inwards"));
    CHECK_THAT(complaint(room(room(outer, sphere(0, 3)), sphere(0, 1))), Contains("inside another body"));
    CHECK_THAT(complaint(room(turned_inside_out(outer), sphere(0, 1))), Contains("oriented inwards"));
}

TEST_CASE("many bodies are judged quickly", "[boundary]") {
    Surface<3> s = box({-1, -1, -1}, {41, 41, 41}, 20);
    for (int i = 0; i < 1000; ++i) {
        const Point<3> centre{4.0 * (i % 10) + 2, 4.0 * (i / 10 % 10) + 2, 4.0 * (i / 100) + 2};
        s = room(std::move(s), ball(centre, 1, 1));
    }
    CHECK(complaint(s) == "");
}
