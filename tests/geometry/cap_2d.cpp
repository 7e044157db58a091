// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

using namespace slabhull;

namespace {

using Polygon = std::vector<Point<2>>; // counter-clockwise

/// Appends a polygon: an outer curve runs clockwise, so that the domain is on its right, a hole the other
/// way.
void add_curve(Surface<2>& surface, const Polygon& polygon, bool hole) {
    const auto first = static_cast<Index>(surface.points.size());
    const auto count = static_cast<Index>(polygon.size());
    surface.points.insert(surface.points.end(), polygon.begin(), polygon.end());
    for (Index i = 0; i < count; ++i) {
        const Index a = first + i;
        const Index b = first + (i + 1) % count;
        surface.facets.push_back(hole ? Facet<2>{a, b} : Facet<2>{b, a});
        surface.patch.push_back(hole ? 2 : 1);
    }
    surface.patches = {{1, "walls"}, {2, "body"}};
}

Polygon box(double half, int edges_per_side) {
    Polygon polygon;
    for (int side = 0; side < 4; ++side) {
        for (int i = 0; i < edges_per_side; ++i) {
            const double along = -half + 2 * half * i / edges_per_side;
            const std::array<Point<2>, 4> turned{
                {{along, -half}, {half, along}, {-along, half}, {-half, -along}}};
            polygon.push_back(turned[static_cast<std::size_t>(side)]);
        }
    }
    return polygon;
}

Polygon circle(const Point<2>& centre, double radius, int edges) {
    Polygon polygon;
    for (int i = 0; i < edges; ++i) {
        const double angle = 2 * std::numbers::pi * i / edges;
        polygon.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
    }
    return polygon;
}

/// Joukowski-like profile of the NACA 0012 with a closed, sharp trailing edge of about 16 degrees.
Polygon airfoil(int edges) {
    Polygon polygon;
    for (int i = 0; i < edges; ++i) {
        const double angle = 2 * std::numbers::pi * i / edges;
        const double x = (1 + std::cos(angle)) / 2;
        const double y =
            0.6 * (0.2969 * std::sqrt(x) + x * (-0.126 + x * (-0.3516 + x * (0.2843 - x * 0.1036))));
        polygon.push_back({x, i == 0 ? 0 : 2 * i <= edges ? y : -y});
    }
    return polygon;
}

Polygon star(int tips) {
    Polygon polygon;
    for (int i = 0; i < 2 * tips; ++i) {
        const double angle = std::numbers::pi * i / tips;
        const double radius = i % 2 == 0 ? 4 : 1.5;
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return polygon;
}

Surface<2> plain_square(int edges = 20) {
    Surface<2> surface;
    add_curve(surface, box(5, edges), false);
    return surface;
}
Surface<2> with_holes(Surface<2> surface, const std::vector<Polygon>& holes) {
    for (const Polygon& hole : holes) {
        add_curve(surface, hole, true);
    }
    return surface;
}

struct Specimen {
    std::string name;
    Surface<2> surface;
    int holes = 0;
    bool easy = true; ///< the boundary allows 20 degrees everywhere
};

Surface<2> random_holes(int count) {
    Surface<2> surface = plain_square(100);
    std::mt19937_64 random{11};
    const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
    const double cell = 9.6 / columns;
    std::uniform_real_distribution<double> part{0, 1};
    for (int i = 0; i < count; ++i) {
        const double radius = cell * (0.1 + 0.2 * part(random));
        const double slack = cell / 2 - 1.3 * radius;
        const Point<2> centre{-4.8 + cell * (i % columns + 0.5) + slack * (2 * part(random) - 1),
                              -4.8 + cell * (i / columns + 0.5) + slack * (2 * part(random) - 1)};
        add_curve(surface, circle(centre, radius, 12 + i % 20), true);
    }
    return surface;
}

std::vector<Specimen> specimens() {
    Surface<2> ring;
    add_curve(ring, circle({0, 0}, 3, 100), false);
    Surface<2> profile;
    add_curve(profile, airfoil(120), false);
    Surface<2> jagged;
    add_curve(jagged, star(5), false);
    Surface<2> uneven;
    add_curve(uneven, {{0, 0}, {4, 0}, {4.001, 0}, {9, 0}, {9, 5}, {4.5, 5}, {4.49, 5.2}, {0, 5}}, false);
    return {
        {"square", plain_square(), 0},
        {"square of four edges", plain_square(1), 0},
        {"square with a hole", with_holes(plain_square(), {circle({0, 0}, 1, 60)}), 1},
        {"several holes",
         with_holes(plain_square(40),
                    {circle({-2, -2}, 1, 40), circle({2, 1}, 1.5, 80), circle({-2, 2}, 0.5, 70)}),
         3},
        {"ring", with_holes(ring, {circle({0.5, 0}, 1, 50)}), 1},
        {"around an airfoil", with_holes(plain_square(), {airfoil(200)}), 1},
        {"a hundred holes", random_holes(100), 100},
        {"fine hole, coarse walls", with_holes(plain_square(4), {circle({0, 0}, 1, 2000)}), 1},
        {"fine hole, walls of one edge", with_holes(plain_square(1), {circle({0.3, 0.1}, 1, 1000)}), 1,
         false},
        {"narrow gap", with_holes(plain_square(10), {circle({3.9, 0}, 1, 100)}), 1, false},
        {"narrow gap at a long edge", with_holes(plain_square(2), {circle({3.9, 0.3}, 1, 100)}), 1, false},
        {"inside an airfoil", profile, 0, false},
        {"star", jagged, 0, false},
        {"uneven edges", uneven, 0, false},
    };
}

std::array<Point<2>, 3> corners(const CapMesh<2>& mesh, std::size_t cell) {
    return corners_of<2, 2>(mesh.cells[cell], mesh.points);
}

double smallest_angle(const CapMesh<2>& mesh) {
    double smallest = 180;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        smallest = std::min(smallest, dihedral_angles<2, 2>(corners(mesh, c)).smallest);
    }
    return smallest;
}

/// Area that the curves enclose: the domain is on the right of each edge.
double area_of(const Surface<2>& surface) {
    double twice = 0;
    for (const Facet<2>& edge : surface.facets) {
        const Point<2>& a = surface.points[edge[0]];
        const Point<2>& b = surface.points[edge[1]];
        twice += b[0] * a[1] - a[0] * b[1];
    }
    return twice / 2;
}

std::set<Facet<2>> boundary_of(const CapMesh<2>& mesh) {
    std::set<Facet<2>> edges;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (int i = 0; i < 3; ++i) {
            if (mesh.neighbors[c][static_cast<std::size_t>(i)] == no_index) {
                edges.insert(outward_facet<2>(mesh.cells[c], i));
            }
        }
    }
    return edges;
}

/// Wrong entries among the neighbors: not mutual, or across another edge.
std::size_t wrong_neighbors(const CapMesh<2>& mesh) {
    std::size_t wrong = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (int i = 0; i < 3; ++i) {
            const Index other = mesh.neighbors[c][static_cast<std::size_t>(i)];
            if (other == no_index) {
                continue;
            }
            const Facet<2> mine = outward_facet<2>(mesh.cells[c], i);
            int matches = 0;
            for (int k = 0; k < 3; ++k) {
                const bool back = mesh.neighbors[other][static_cast<std::size_t>(k)] == c;
                matches +=
                    back && outward_facet<2>(mesh.cells[other], k) == Facet<2>{mine[1], mine[0]} ? 1 : 0;
            }
            wrong += matches == 1 ? 0 : 1;
        }
    }
    return wrong;
}

/// Interior edges whose opposite vertex is clearly inside the circumcircle of the triangle on the other side.
std::size_t not_delaunay(const CapMesh<2>& mesh) {
    std::size_t found = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const std::array<Point<2>, 3> p = corners(mesh, c);
        for (const Index other : mesh.neighbors[c]) {
            if (other == no_index) {
                continue;
            }
            for (const Index v : mesh.cells[other]) {
                std::array<std::array<long double, 3>, 3> m;
                long double scale = 1;
                for (std::size_t i = 0; i < 3; ++i) {
                    const long double x = static_cast<long double>(p[i][0]) - mesh.points[v][0];
                    const long double y = static_cast<long double>(p[i][1]) - mesh.points[v][1];
                    m[i] = {x, y, x * x + y * y};
                    scale *= std::max(m[i][2], 1e-300L);
                }
                const long double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                                        m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                                        m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
                found += det > 1e-12L * std::pow(scale, 2.0L / 3) ? 1 : 0;
            }
        }
    }
    return found;
}

/// Everything that must hold for any cap.
void check_cap(const CapMesh<2>& mesh, const Surface<2>& surface, int holes) {
    REQUIRE(mesh.points.size() >= surface.points.size());
    CHECK(std::memcmp(mesh.points.data(), surface.points.data(), surface.points.size() * sizeof(Point<2>)) ==
          0);
    CHECK(boundary_of(mesh) == std::set<Facet<2>>(surface.facets.begin(), surface.facets.end()));

    double area = 0;
    std::size_t inverted = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const double part = signed_measure<2>(corners(mesh, c));
        area += part;
        inverted += part > 0 ? 0 : 1;
    }
    CHECK(inverted == 0);
    CHECK(area == Approx(area_of(surface)).epsilon(1e-12));

    const std::size_t edges = (3 * mesh.cells.size() + surface.facets.size()) / 2;
    CHECK(static_cast<long>(mesh.points.size()) - static_cast<long>(edges) +
              static_cast<long>(mesh.cells.size()) ==
          1 - holes);
    CHECK(wrong_neighbors(mesh) == 0);
    CHECK(not_delaunay(mesh) == 0);
}

/// How many triangles there would be if all were equilateral with edges as the field wants.
double ideal_count(const CapMesh<2>& mesh, const Surface<2>& surface, const Grading& grading) {
    const std::span<const Point<2>> points{surface.points};
    const std::vector<double> spacing = boundary_spacing<2>(points, surface.facets);
    const SizeField<2> field{points, spacing, grading};
    double count = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const std::array<Point<2>, 3> p = corners(mesh, c);
        const double h = field({(p[0][0] + p[1][0] + p[2][0]) / 3, (p[0][1] + p[1][1] + p[2][1]) / 3});
        count += signed_measure<2>(p) * 4 / std::numbers::sqrt3 / (h * h);
    }
    return count;
}

Surface<2> transformed(Surface<2> surface, const std::function<Point<2>(const Point<2>&)>& map) {
    for (Point<2>& p : surface.points) {
        p = map(p);
    }
    return surface;
}

GeometryError refusal(const Surface<2>& surface) {
    try {
        mesh_cap<2>(surface, {});
    } catch (const GeometryError& error) {
        return error;
    }
    FAIL("the surface was meshed");
    return GeometryError{""};
}

std::vector<std::int64_t> numbers(const GeometryError& error) {
    std::vector<std::int64_t> found;
    for (const Entity& entity : error.entities) {
        found.push_back(entity.number);
    }
    return found;
}

} // namespace

TEST_CASE("a cap keeps its boundary and is a Delaunay mesh of the domain", "[cap_2d]") {
    for (const Specimen& specimen : specimens()) {
        INFO(specimen.name);
        check_cap(mesh_cap<2>(specimen.surface, {}), specimen.surface, specimen.holes);
    }
}

TEST_CASE("angles are 20 degrees or more where the boundary allows", "[cap_2d]") {
    for (const Specimen& specimen : specimens()) {
        INFO(specimen.name);
        if (specimen.easy) {
            CHECK(smallest_angle(mesh_cap<2>(specimen.surface, {})) >= 20);
        }
    }
}

TEST_CASE("where the boundary forces small angles they stay few and at the boundary", "[cap_2d]") {
    const Surface<2> gap = with_holes(plain_square(10), {circle({3.9, 0}, 1, 100)});
    const CapMesh<2> mesh = mesh_cap<2>(gap, {});
    std::size_t small = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        if (dihedral_angles<2, 2>(corners(mesh, c)).smallest < 20) {
            ++small;
            for (const Point<2>& p : corners(mesh, c)) {
                CHECK(p[0] > 3.9);
                CHECK(std::abs(p[1]) < 2.1);
            }
        }
    }
    CHECK(small < mesh.cells.size() / 20);
}

TEST_CASE("walls of a few long edges around a fine hole cost few small angles", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(1), {circle({0, 0}, 1, 2000)});
    const CapMesh<2> mesh = mesh_cap<2>(surface, {});
    std::size_t small = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        small += dihedral_angles<2, 2>(corners(mesh, c)).smallest < 20 ? 1 : 0;
    }
    CHECK(small * 200 < mesh.cells.size());
    CHECK(smallest_angle(mesh) > 10);
}

TEST_CASE("triangles are as large as the size field wants", "[cap_2d]") {
    const Surface<2> graded = with_holes(plain_square(100), {circle({0, 0}, 1, 300)});
    for (const Grading& grading : {Grading{0.3}, Grading{0.1}, Grading{0.3, 0.1}, Grading{0}}) {
        const CapMesh<2> mesh = mesh_cap<2>(graded, {grading});
        CHECK(static_cast<double>(mesh.cells.size()) ==
              Approx(ideal_count(mesh, graded, grading)).epsilon(0.2));
    }
}

TEST_CASE("a uniform cap is made of nearly equilateral triangles", "[cap_2d]") {
    const CapMesh<2> mesh = mesh_cap<2>(plain_square(100), {Grading{0}});
    double sum = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        sum += dihedral_angles<2, 2>(corners(mesh, c)).smallest;
    }
    CHECK(sum / static_cast<double>(mesh.cells.size()) > 53);
}

TEST_CASE("the same boundary gives the same bytes, whatever was meshed before", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(), {circle({0, 0}, 1, 64), circle({3, 3}, 0.5, 32)});
    const CapMesh<2> first = mesh_cap<2>(surface, {});
    mesh_cap<2>(plain_square(33), {});
    const CapMesh<2> second = mesh_cap<2>(surface, {});
    CHECK(first.points == second.points);
    CHECK(first.cells == second.cells);
    CHECK(first.neighbors == second.neighbors);
}

TEST_CASE("a cap scaled by a power of two is the scaled cap", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(), {airfoil(100)});
    const auto scale = [](const Point<2>& p) { return Point<2>{p[0] / 4096, p[1] / 4096}; };
    CapMesh<2> mesh = mesh_cap<2>(surface, {});
    const CapMesh<2> small = mesh_cap<2>(transformed(surface, scale), {});
    CHECK(small.cells == mesh.cells);
    std::transform(mesh.points.begin(), mesh.points.end(), mesh.points.begin(), scale);
    CHECK(small.points == mesh.points);
}

TEST_CASE("a turned, moved or mirrored boundary gives a cap of about the same size and quality", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(40), {circle({1, 0.5}, 1, 90)});
    const auto count = static_cast<double>(mesh_cap<2>(surface, {}).cells.size());
    const auto check = [&](const Surface<2>& other) {
        const CapMesh<2> mesh = mesh_cap<2>(other, {});
        check_cap(mesh, other, 1);
        CHECK(static_cast<double>(mesh.cells.size()) == Approx(count).epsilon(0.05));
        CHECK(smallest_angle(mesh) >= 20);
    };
    for (const double angle : {0.1, 0.8, 2.0}) {
        check(transformed(surface, [angle](const Point<2>& p) {
            return Point<2>{std::cos(angle) * p[0] - std::sin(angle) * p[1] + 100,
                            std::sin(angle) * p[0] + std::cos(angle) * p[1] - 50};
        }));
    }
    Surface<2> mirrored = transformed(surface, [](const Point<2>& p) { return Point<2>{-p[0], p[1]}; });
    for (Facet<2>& edge : mirrored.facets) {
        std::swap(edge[0], edge[1]);
    }
    check(mirrored);
}

TEST_CASE("the order of the edges and the numbers of the points do not matter for validity", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(), {circle({0, 0}, 1, 40)});
    Surface<2> shuffled = surface;
    std::vector<Index> place(surface.points.size());
    for (std::size_t i = 0; i < place.size(); ++i) {
        place[i] = static_cast<Index>(i);
    }
    std::mt19937_64 random{4};
    std::shuffle(place.begin(), place.end(), random);
    for (std::size_t i = 0; i < place.size(); ++i) {
        shuffled.points[place[i]] = surface.points[i];
    }
    for (Facet<2>& edge : shuffled.facets) {
        edge = {place[edge[0]], place[edge[1]]};
    }
    std::shuffle(shuffled.facets.begin(), shuffled.facets.end(), random);
    check_cap(mesh_cap<2>(shuffled, {}), shuffled, 1);
}

TEST_CASE("an island in a hole is a domain of its own", "[cap_2d]") {
    Surface<2> surface = with_holes(plain_square(), {circle({0, 0}, 3, 60)});
    add_curve(surface, circle({0, 0}, 1, 20), false);
    const CapMesh<2> mesh = mesh_cap<2>(surface, {});
    // Two pieces, one with a hole: Euler characteristic 0 + 1.
    check_cap(mesh, surface, 0);
}

TEST_CASE("a narrow slit of nearly parallel edges is meshed", "[cap_2d]") {
    Surface<2> slit;
    add_curve(slit, {{0, 0}, {5, 0}, {10, 0}, {10, 1e-9}, {5, 2e-9}, {0, 1e-9}}, false);
    check_cap(mesh_cap<2>(slit, {}), slit, 0);
}

TEST_CASE("any wanted angle comes to an end", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(7), {circle({3.8, 0}, 1, 50)});
    for (const double angle : {-5.0, 0.0, 30.0, 45.0, 89.0, std::numeric_limits<double>::quiet_NaN()}) {
        CapOptions options;
        options.min_angle = angle;
        check_cap(mesh_cap<2>(surface, options), surface, 1);
    }
}

TEST_CASE("cells that are near each other in the mesh are near in the order", "[cap_2d]") {
    const CapMesh<2> mesh = mesh_cap<2>(plain_square(200), {Grading{0}});
    std::size_t near = 0;
    std::size_t all = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (const Index n : mesh.neighbors[c]) {
            if (n != no_index) {
                ++all;
                near += std::max<std::size_t>(n, c) - std::min<std::size_t>(n, c) < 1000 ? 1 : 0;
            }
        }
    }
    CHECK(near * 10 > all * 9);
}

TEST_CASE("crossing edges are refused by number", "[cap_2d]") {
    Surface<2> bow;
    add_curve(bow, {{0, 0}, {2, 2}, {2, 0}, {0, 2}}, false);
    CHECK(numbers(refusal(bow)) == std::vector<std::int64_t>{0, 2});

    const Surface<2> through_wall = with_holes(plain_square(1), {circle({5.2, 0.1}, 1, 8)});
    const GeometryError error = refusal(through_wall);
    REQUIRE(error.entities.size() == 2);
    CHECK(error.entities[0].number == 1);
    CHECK(error.entities[0].patch == "walls");
    CHECK(error.entities[1].patch == "body");
}

TEST_CASE("a vertex on an edge is refused", "[cap_2d]") {
    const Surface<2> touching = with_holes(plain_square(1), {{{5, 0}, {4, 1}, {4, -1}}});
    const GeometryError error = refusal(touching);
    CHECK(numbers(error) == std::vector<std::int64_t>{4, 1});
    CHECK_THAT(error.what(), Catch::Contains("lies on"));
}

TEST_CASE("coincident points are refused by number", "[cap_2d]") {
    Surface<2> pinched;
    add_curve(pinched, {{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}}, false);
    CHECK(numbers(refusal(pinched)) == std::vector<std::int64_t>{2, 5});
}

TEST_CASE("open and doubled curves are refused", "[cap_2d]") {
    Surface<2> open = plain_square(3);
    open.facets.pop_back();
    CHECK_THAT(refusal(open).what(), Catch::Contains("starts"));

    Surface<2> doubled = plain_square(3);
    doubled.facets.push_back(doubled.facets[0]);
    CHECK_THAT(refusal(doubled).what(), Catch::Contains("starts"));

    Surface<2> turned = plain_square(3);
    std::swap(turned.facets[4][0], turned.facets[4][1]);
    CHECK_THAT(refusal(turned).what(), Catch::Contains("starts"));

    Surface<2> unused = plain_square(3);
    unused.points.push_back({0, 0});
    CHECK(numbers(refusal(unused)) == std::vector<std::int64_t>{12});
}

TEST_CASE("curves that disagree about where the domain is are refused", "[cap_2d]") {
    Surface<2> inside_out;
    add_curve(inside_out, box(1, 2), true);
    CHECK_THAT(refusal(inside_out).what(), Catch::Contains("outside"));

    Surface<2> wrong_hole = plain_square(3);
    add_curve(wrong_hole, circle({0, 0}, 1, 8), false);
    CHECK_THAT(refusal(wrong_hole).what(), Catch::Contains("opposite sides"));

    const Surface<2> beside = with_holes(plain_square(3), {circle({20, 0}, 1, 8)});
    refusal(beside);
}

TEST_CASE("numbers that are none and an empty boundary are refused", "[cap_2d]") {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Surface<2> surface = plain_square(3);
        surface.points[5][1] = bad;
        CHECK(numbers(refusal(surface)) == std::vector<std::int64_t>{5});
    }
    Surface<2> dangling = plain_square(3);
    dangling.facets[2][1] = 400;
    CHECK(numbers(refusal(dangling)) == std::vector<std::int64_t>{2});
    refusal(Surface<2>{});
    Surface<2> flat;
    add_curve(flat, {{0, 0}, {1, 0}}, false);
    refusal(flat);
    Surface<2> line;
    add_curve(line, {{0, 0}, {1, 0}, {3, 0}}, false);
    refusal(line);
}

TEST_CASE("lengths at the ends of the range of double are meshed or refused", "[cap_2d]") {
    const auto sized = [](double size) {
        return transformed(plain_square(4), [size](const Point<2>& p) {
            return Point<2>{size * p[0], size * p[1]};
        });
    };
    for (const double size : {1e-40, 1e40}) {
        check_cap(mesh_cap<2>(sized(size), {}), sized(size), 0);
    }
    for (const double size : {1e-310, 1e-200, 1e150, 3e307}) {
        CHECK_THAT(refusal(sized(size)).what(), Catch::Contains("between"));
    }
}

TEST_CASE("a spacing that asks for more triangles than can be counted is refused", "[cap_2d]") {
    const Surface<2> surface = with_holes(plain_square(1), {circle({0, 0}, 1e-6, 20)});
    CapOptions options;
    options.grading.growth = 0;
    CHECK_THROWS_AS(mesh_cap<2>(surface, options), LimitError);
}
