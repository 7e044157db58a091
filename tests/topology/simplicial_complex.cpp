// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/simplicial_complex.h"

#include "slabhull/core/error.h"

#include "slabhull/topology/adjacency.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <map>
#include <set>
#include <string>
#include <utility>

using namespace slabhull;
using specimens::Complex;

// --- ids of one kind do not pass for those of another

template<class Mesh, class Argument>
concept has_star_of = requires(const Mesh& mesh, Argument argument) {
    mesh.star(argument);
};
template<class Mesh>
concept seen_by_view = requires(Mesh mesh) {
    view_of(std::forward<Mesh>(mesh));
};

static_assert(has_star_of<SimplicialComplex<3>, VertexId>);
static_assert(!has_star_of<SimplicialComplex<3>, CellId>);
static_assert(!has_star_of<SimplicialComplex<3>, Index>);
static_assert(!has_star_of<SimplicialComplex<3>, HalfFacetId<3>>);
static_assert(!std::equality_comparable_with<HalfFacetId<2>, HalfFacetId<3>>);
static_assert(!std::equality_comparable_with<VertexId, CellId>);
static_assert(sizeof(HalfFacetId<3>) == 8);
static_assert(std::ranges::random_access_range<decltype(std::declval<SimplicialComplex<3>>().cells())>);

namespace {

template<int D>
SimplicialComplex<D> opened(const Complex<D>& complex) {
    return SimplicialComplex<D>::from_soup(complex.cells, complex.vertices);
}

/// A closed or open complex without some of its cells.
template<int D>
Complex<D> without_cells(Complex<D> complex, std::size_t first, std::size_t count) {
    const auto begin = complex.cells.begin() + static_cast<std::ptrdiff_t>(first);
    complex.cells.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return complex;
}

Complex<1> polygon(Index n, bool closed) {
    Complex<1> result{{}, n};
    for (Index i = 0; i + (closed ? 0 : 1) < n; ++i) {
        result.cells.push_back({i, (i + 1) % n});
    }
    return result;
}

/// m x n squares around a cylinder, each in two triangles, anticlockwise.
Complex<2> cylinder(Index m, Index n) {
    Complex<2> result{{}, m * (n + 1)};
    for (Index j = 0; j < n; ++j) {
        for (Index i = 0; i < m; ++i) {
            const Index a = j * m + i, b = j * m + (i + 1) % m;
            result.cells.push_back({a, b, b + m});
            result.cells.push_back({a, b + m, a + m});
        }
    }
    return result;
}

template<int D>
std::vector<Complex<D>> family() {
    std::vector<Complex<D>> members;
    if constexpr (D == 1) {
        members = {polygon(3, true), polygon(9, true), polygon(2, false), polygon(8, false),
                   specimens::disjoint_union(polygon(5, false), polygon(4, true))};
    } else {
        using namespace specimens;
        members = {sphere<D>(),
                   refined(sphere<D>()),
                   torus<D>(4),
                   disjoint_union(sphere<D>(), torus<D>(3)),
                   without_cells(sphere<D>(), 0, 1),
                   without_cells(refined(torus<D>(3)), 4, 1),
                   without_cells(sphere<D>(), 1, D + 1)};
        if constexpr (D == 2) {
            members.push_back(cylinder(5, 3));
            members.push_back(cylinder(3, 1));
        } else {
            members.push_back(projective_space());
            members.push_back(times_circle(cylinder(5, 2), 4));
            members.push_back(times_circle(without_cells(torus<2>(3), 0, 1), 3));
            members.push_back(suspension(refined(sphere<2>())));
        }
        for (std::size_t k = members.size(); k-- > 0;) {
            members.push_back(shuffled(members[k], static_cast<unsigned>(k)));
        }
    }
    return members;
}

template<int D>
std::set<CellId> cells_with(const Complex<D>& complex, const std::vector<Index>& vertices) {
    std::set<CellId> result;
    for (std::size_t c = 0; c < complex.cells.size(); ++c) {
        const auto& cell = complex.cells[c];
        if (std::ranges::all_of(vertices, [&](Index v) { return std::ranges::count(cell, v) == 1; })) {
            result.insert(CellId{static_cast<Index>(c)});
        }
    }
    return result;
}

template<class T>
std::set<T> as_set(const std::vector<T>& list) {
    std::set<T> result{list.begin(), list.end()};
    REQUIRE(result.size() == list.size());
    return result;
}

template<int D>
bool adjacent(const SimplicialComplex<D>& mesh, CellId a, CellId b) {
    return std::ranges::any_of(mesh.half_facets(a), [&](auto h) { return mesh.across(h) == b; });
}

/// A list of cells goes from neighbour to neighbour, and back to its start when it is closed.
template<int D>
void require_fan(const SimplicialComplex<D>& mesh, const std::vector<CellId>& fan, bool closed) {
    for (std::size_t k = 1; k < fan.size(); ++k) {
        REQUIRE(adjacent(mesh, fan[k - 1], fan[k]));
    }
    if (closed) {
        REQUIRE(adjacent(mesh, fan.back(), fan.front()));
    }
}

template<std::size_t N>
bool even_permutation_of(std::array<Index, N> a, const std::array<VertexId, N>& b) {
    std::array<Index, N> order{};
    for (std::size_t i = 0; i < N; ++i) {
        const auto at = std::ranges::find(b, VertexId{a[i]});
        REQUIRE(at != b.end());
        order[i] = static_cast<Index>(at - b.begin());
    }
    return !specimens::odd_permutation(order);
}

// --- the questions, answered once more from the list of cells

template<int D>
void require_facets_right(const Complex<D>& complex, const SimplicialComplex<D>& mesh) {
    std::set<HalfFacetId<D>> open;
    for (const auto h : mesh.half_facets()) {
        std::vector<Index> facet;
        for (const VertexId v : mesh.vertices(h)) {
            facet.push_back(v.slot());
        }
        std::set<CellId> sides = cells_with(complex, facet);
        REQUIRE(sides.erase(h.cell()) == 1);
        REQUIRE(std::ranges::count(facet, mesh.apex(h).slot()) == 0);
        if (sides.empty()) {
            open.insert(h);
            REQUIRE_FALSE(mesh.across(h).valid());
            REQUIRE_FALSE(mesh.mirror(h).valid());
            continue;
        }
        REQUIRE(mesh.across(h) == *sides.begin());
        const auto mirror = mesh.mirror(h);
        REQUIRE(mirror.cell() == mesh.across(h));
        REQUIRE(mesh.mirror(mirror) == h);
        REQUIRE(std::ranges::count(facet, mesh.apex(mirror).slot()) == 0);
    }
    std::set<HalfFacetId<D>> found;
    for (const auto h : mesh.boundary_facets()) {
        found.insert(h);
    }
    REQUIRE(found == open);
    REQUIRE(mesh.closed() == open.empty());
}

template<int D>
void require_vertices_right(const Complex<D>& complex, const SimplicialComplex<D>& mesh) {
    for (const VertexId v : mesh.vertices()) {
        const auto star = mesh.star(v);
        const auto expected = cells_with(complex, {v.slot()});
        REQUIRE(as_set(star) == expected);
        REQUIRE(mesh.cell_of(v) == (expected.empty() ? CellId{} : *expected.begin()));
        const auto link = mesh.link(v);
        REQUIRE(link.size() == star.size());
        std::set<VertexId> around;
        for (std::size_t k = 0; k < link.size(); ++k) {
            REQUIRE(link[k].cell() == star[k]);
            REQUIRE(mesh.apex(link[k]) == v);
            for (const VertexId w : mesh.vertices(link[k])) {
                around.insert(w);
            }
        }
        REQUIRE(as_set(mesh.neighbors(v)) == around);
        if constexpr (D == 2) {
            const bool closed = !star.empty() && around.size() == star.size();
            require_fan(mesh, star, closed);
        }
    }
}

template<int D>
void require_edge_right(const Complex<D>& complex, const SimplicialComplex<D>& mesh, VertexId a, VertexId b) {
    const auto star = mesh.star(a, b);
    const auto link = mesh.link(a, b);
    REQUIRE(as_set(star) == cells_with(complex, {a.slot(), b.slot()}));
    std::set<VertexId> around;
    for (const CellId cell : star) {
        for (const VertexId v : mesh.vertices(cell)) {
            around.insert(v);
        }
    }
    around.erase(a);
    around.erase(b);
    REQUIRE(as_set(link) == around);
    if constexpr (D == 3) {
        const bool closed = link.size() == star.size();
        REQUIRE((closed || link.size() == star.size() + 1));
        require_fan(mesh, star, closed);
        for (std::size_t k = 0; k < star.size(); ++k) {
            const VertexId next = link[(k + 1) % link.size()];
            REQUIRE(even_permutation_of<4>({a.slot(), b.slot(), link[k].slot(), next.slot()},
                                           mesh.vertices(star[k])));
        }
    }
}

template<int D>
void require_edges_right(const Complex<D>& complex, const SimplicialComplex<D>& mesh) {
    for (const CellId cell : mesh.cells()) {
        std::set<std::set<VertexId>> met;
        for (const auto& [a, b] : mesh.edges(cell)) {
            REQUIRE(mesh.has(cell, a));
            REQUIRE(mesh.has(cell, b));
            met.insert({a, b});
            require_edge_right(complex, mesh, a, b);
            require_edge_right(complex, mesh, b, a);
        }
        REQUIRE(met.size() == D * (D + 1) / 2);
    }
}

template<int D>
void require_navigation_right() {
    for (const Complex<D>& complex : family<D>()) {
        const auto mesh = opened(complex);
        REQUIRE(mesh.cell_count() == complex.cells.size());
        REQUIRE(mesh.vertex_count() == complex.vertices);
        require_facets_right(complex, mesh);
        require_vertices_right(complex, mesh);
        require_edges_right(complex, mesh);
    }
}

template<int D>
std::string refusal(const Complex<D>& complex, std::vector<std::int64_t> cells) {
    try {
        opened(complex);
    } catch (const GeometryError& error) {
        std::vector<std::int64_t> named;
        for (const Entity& entity : error.entities) {
            CHECK(entity.kind == "cell");
            named.push_back(entity.number);
        }
        std::ranges::sort(named);
        CHECK(named == cells);
        return error.what();
    }
    return "";
}

using Catch::Contains;

} // namespace

TEST_CASE("navigation agrees with the list of cells, on curves, surfaces and 3-manifolds, closed and open") {
    require_navigation_right<1>();
    require_navigation_right<2>();
    require_navigation_right<3>();
}

TEST_CASE("where there is no edge, nothing is around it") {
    const auto mesh = opened(specimens::torus<3>(4));
    CHECK(mesh.star(VertexId{0}, VertexId{2}).empty());
    CHECK(mesh.link(VertexId{0}, VertexId{2}).empty());
    CHECK(mesh.star(VertexId{5}, VertexId{5}).empty());
    Complex<2> lonely = specimens::sphere<2>();
    ++lonely.vertices;
    const auto sphere = opened(lonely);
    CHECK(sphere.star(VertexId{4}).empty());
    CHECK(sphere.neighbors(VertexId{4}).empty());
    CHECK(sphere.star(VertexId{4}, VertexId{0}).empty());
}

TEST_CASE("the star of a vertex of a surface turns anticlockwise") {
    const auto mesh = opened(cylinder(6, 4));
    for (const VertexId v : mesh.vertices()) {
        const auto link = mesh.link(v);
        for (std::size_t k = 1; k < link.size(); ++k) { // outward edges have the cell on their right
            REQUIRE(mesh.vertices(link[k - 1])[0] == mesh.vertices(link[k])[1]);
        }
    }
}

// --- what is no manifold is reported, with the cells at fault

TEST_CASE("a Moebius band is reported with the triangles that disagree") {
    Complex<2> band{{}, 5};
    for (Index i = 0; i < 5; ++i) {
        band.cells.push_back({i, (i + 1) % 5, (i + 2) % 5});
        if (i % 2 == 1) {
            std::swap(band.cells.back()[0], band.cells.back()[1]);
        }
    }
    CHECK_THAT(refusal(band, {0, 4}), Contains("edge (0, 1) is in 2 triangles: 0, 4, which disagree"));
}

TEST_CASE("facets in three cells are reported") {
    CHECK_THAT(refusal<2>({{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5}, {0, 1, 2}),
               Contains("edge (0, 1) is in 3 triangles: 0, 1, 2"));
    CHECK_THAT(refusal<1>({{{0, 1}, {1, 2}, {3, 1}}, 4}, {0, 1, 2}), Contains("vertex 1 is in 3 edges"));
    CHECK_THAT(refusal<3>({{{0, 1, 2, 3}, {1, 0, 2, 4}, {0, 1, 2, 5}}, 6}, {0, 1, 2}),
               Contains("triangle (0, 1, 2) is in 3 tetrahedra"));
}

TEST_CASE("cells that touch in a vertex or an edge only are reported") {
    CHECK_THAT(refusal<2>({{{0, 1, 2}, {0, 3, 4}}, 5}, {0, 1}),
               Contains("triangles at vertex 0 do not form a fan"));
    CHECK_THAT(refusal<3>({{{0, 1, 2, 3}, {0, 4, 5, 6}}, 7}, {0, 1}),
               Contains("tetrahedra at vertex 0 do not form a ball"));
    CHECK_THAT(refusal<3>({{{0, 1, 2, 3}, {0, 1, 4, 5}}, 6}, {0, 1}), Contains("at vertex 1"));
}

TEST_CASE("a vertex whose link is connected but pinched is reported") {
    // A ball around a vertex, two opposite vertices of its sphere made one: no facet is in more than two
    // cells.
    const auto torus = opened(specimens::torus<3>(5));
    const auto ball = part_of<3>(torus, torus.star(VertexId{62})); // at (2, 2, 2)
    const auto place = [&](Index v) {
        return static_cast<Index>(std::ranges::find(ball.vertices, VertexId{v}) - ball.vertices.begin());
    };
    Complex<3> pinched{{ball.complex.cell_array().begin(), ball.complex.cell_array().end()},
                       ball.complex.vertex_count()};
    specimens::merge_vertices(pinched, place(61), place(63));
    REQUIRE_THROWS_WITH(opened(pinched), Contains(fmt::format("tetrahedra at vertex {} do not", place(62))));
}

TEST_CASE("a cone over a torus is reported: its link is connected, but no sphere") {
    const auto suspended = specimens::suspension(specimens::torus<2>(3));
    REQUIRE_THROWS_WITH(opened(suspended), Contains("at vertex 9 do not form a ball"));
}

TEST_CASE("cells that make no sense are reported before anything is made of them") {
    CHECK_THAT(refusal<2>({{{0, 1, 2}, {1, 1, 3}}, 4}, {1}),
               Contains("triangle 1 (1, 1, 3) names a vertex twice"));
    CHECK_THAT(refusal<3>({{{0, 1, 2, 9}}, 4}, {0}), Contains("names vertex 9 of 4"));
    CHECK_THAT(refusal<2>({{{0, 1, 2}, {0, 2, 1}}, 3}, {0, 1}), Contains("0 and 1 have the same vertices"));
    CHECK_THAT(refusal<1>({{{0, 1}, {1, 0}}, 2}, {0, 1}), Contains("have the same vertices"));
}

TEST_CASE("a long list of faults is cut short in words, not in number") {
    Complex<2> dust{{}, 300};
    for (Index i = 0; i < 100; ++i) {
        dust.cells.push_back({3 * i, 3 * i, 3 * i + 1});
    }
    REQUIRE_THROWS_WITH(opened(dust), Contains("and 97 more"));
}

// --- parts

TEST_CASE("the boundary of a boundary is empty, and has the adjacency that its facets have as a soup") {
    for (const Complex<3>& complex : family<3>()) {
        const auto mesh = opened(complex);
        const auto boundary = boundary_of(mesh);
        const SimplicialComplex<2>& surface = boundary.complex;
        CHECK(surface.closed());
        CHECK(surface.cell_count() ==
              static_cast<std::size_t>(std::ranges::distance(mesh.boundary_facets())));
        const auto cells = surface.cell_array();
        const auto again = build_adjacency<2>(cells, surface.vertex_count());
        CHECK(again.defects.empty());
        CHECK(std::ranges::equal(again.neighbors, surface.neighbor_array()));
        for (const CellId f : surface.cells()) {
            const auto corners = mesh.vertices(boundary.cells[f.slot()]);
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK(boundary.vertices[surface.vertices(f)[i].slot()] == corners[i]);
            }
        }
    }
}

TEST_CASE("the boundary of a ball is a sphere, that of a solid torus a torus") {
    const auto euler = [](const Complex<3>& complex) {
        const auto surface = boundary_of(opened(complex)).complex;
        return static_cast<long>(surface.vertex_count()) - static_cast<long>(surface.cell_count()) / 2;
    };
    CHECK(euler(without_cells(specimens::refined(specimens::sphere<3>()), 7, 1)) == 2);
    CHECK(euler(specimens::times_circle(without_cells(specimens::refined(specimens::sphere<2>()), 0, 3),
                                        5)) == 0);
    CHECK(euler(specimens::times_circle(cylinder(5, 2), 4)) == 0); // two tori
}

TEST_CASE("boundary loops are found, with the cells on their right") {
    const auto mesh = opened(cylinder(7, 3));
    const auto found = boundary_loops(mesh);
    REQUIRE(found.size() == 2);
    const auto numbers = [](const std::vector<VertexId>& loop) {
        std::vector<Index> result;
        for (const VertexId v : loop) {
            result.push_back(v.slot());
        }
        return result;
    };
    CHECK(numbers(found[0]) ==
          std::vector<Index>{1, 0, 6, 5, 4, 3, 2}); // against the edges 0-1, 1-2 .. of its cells
    CHECK(numbers(found[1]) == std::vector<Index>{21, 22, 23, 24, 25, 26, 27});
    CHECK(boundary_loops(opened(specimens::torus<2>(4))).empty());
    CHECK(boundary_loops(opened(without_cells(specimens::torus<2>(4), 3, 1))).size() == 1);
}

TEST_CASE("chains and loops of a curve are followed in the sense of its edges") {
    const auto found = loops(opened(specimens::disjoint_union(polygon(4, false), polygon(3, true))));
    REQUIRE(found.size() == 2);
    CHECK(found[0] == std::vector<VertexId>{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}});
    CHECK(found[1] == std::vector<VertexId>{VertexId{4}, VertexId{5}, VertexId{6}});
}

// --- views

TEST_CASE("a view of arrays answers as the complex of their soup does") {
    const auto complex = specimens::torus<3>(4);
    const auto adjacency = build_adjacency<3>(complex.cells, complex.vertices);
    const auto view = SimplicialComplex<3>::view(complex.cells, adjacency.neighbors, complex.vertices);
    CHECK(view.cell_array().data() == complex.cells.data());
    const auto own = opened(complex);
    for (const VertexId v : view.vertices()) {
        CHECK(view.star(v) == own.star(v));
    }
}

TEST_CASE("hulls and spatial meshes are seen without a copy") {
    const auto torus = specimens::torus<2>(4);
    Hull<2> hull;
    hull.cells = torus.cells;
    hull.points.resize(torus.vertices);
    hull.neighbors = build_adjacency<2>(torus.cells, torus.vertices).neighbors;
    const auto view = view_of(hull);
    CHECK(view.cell_array().data() == hull.cells.data());
    CHECK(view.neighbor_array().data() == hull.neighbors.data());
    CHECK(view.closed());

    SpatialMesh<3> mesh;
    mesh.cells = {{0, 1, 2, 3}};
    mesh.neighbors = {{no_index, no_index, no_index, no_index}};
    mesh.points.resize(4);
    CHECK(std::ranges::distance(view_of(mesh).boundary_facets()) == 4);
    static_assert(!seen_by_view<Hull<2>&&> && seen_by_view<const Hull<2>&>);
}

TEST_CASE("a vertex with very many cells is walked as quickly as others, cell by cell") {
    auto surface = specimens::sphere<2>();
    for (int k = 0; k < 9; ++k) {
        surface = specimens::refined(surface);
    }
    const auto mesh = opened(specimens::suspension(surface));
    const VertexId apex{static_cast<Index>(surface.vertices)};
    CHECK(mesh.star(apex).size() == surface.cells.size());
    CHECK(mesh.link(apex).size() == surface.cells.size());
    CHECK(mesh.neighbors(apex).size() == surface.vertices);
    CHECK(mesh.star(apex, VertexId{0}).size() == mesh.link(apex, VertexId{0}).size());
}

TEST_CASE("arrays that do not fit together are refused") {
    auto complex = specimens::sphere<3>();
    auto neighbors = build_adjacency<3>(complex.cells, complex.vertices).neighbors;
    const auto open = [&] { SimplicialComplex<3>::view(complex.cells, neighbors, complex.vertices); };
    CHECK_NOTHROW(open());
    neighbors[3][1] = 5;
    CHECK_THROWS_WITH(open(), Contains("cell 3 has a neighbour that does not exist"));
    neighbors[3][1] = no_index;
    complex.cells[2][0] = 77;
    CHECK_THROWS_WITH(open(), Contains("cell 2 refers to a vertex that does not exist"));
    neighbors.pop_back();
    CHECK_THROWS_WITH(open(), Contains("5 cells, but neighbours of 4"));
}

TEMPLATE_TEST_CASE_SIG("no walk is endless, whatever the neighbours say", "", ((int D), D), 1, 2, 3) {
    std::mt19937 random{5};
    const Complex<D> complex = [] {
        if constexpr (D == 1) {
            return polygon(30, true);
        } else {
            return specimens::torus<D>(4);
        }
    }();
    const auto sound = build_adjacency<D>(complex.cells, complex.vertices).neighbors;
    for (int round = 0; round < 60; ++round) {
        auto neighbors = sound;
        for (auto& across : neighbors) {
            for (Index& n : across) {
                if (random() % 8 == 0) {
                    n = random() % 5 == 0 ? no_index : static_cast<Index>(random() % complex.cells.size());
                }
            }
        }
        const auto mesh = SimplicialComplex<D>::view(complex.cells, neighbors, complex.vertices);
        for (const VertexId v : mesh.vertices()) {
            REQUIRE(mesh.star(v).size() <= mesh.cell_count() + 1);
            for (const VertexId w : mesh.neighbors(v)) {
                REQUIRE(mesh.star(v, w).size() <= 2 * mesh.cell_count());
                mesh.link(v, w);
            }
        }
        if constexpr (D >= 2) {
            try {
                boundary_of(mesh);
            } catch (const GeometryError&) {
            }
        } else {
            loops(mesh);
        }
    }
}
