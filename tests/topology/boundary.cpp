// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/boundary.h"

#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/halfedge_mesh.h"
#include "slabhull/topology/simplicial_complex.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <concepts>
#include <set>
#include <utility>

using namespace slabhull;
using Catch::Contains;

template<class Argument>
concept has_facets_at = requires(const HalfedgeMesh& mesh, Argument argument) {
    mesh.facets(argument);
};
static_assert(has_facets_at<VertexId> && has_facets_at<EdgeId>);
static_assert(!has_facets_at<FacetId> && !has_facets_at<HalfedgeId> && !has_facets_at<Index>);
static_assert(!std::equality_comparable_with<EdgeId, HalfedgeId>);
static_assert(!std::equality_comparable_with<FacetId, VertexId>);

namespace {

/// Connectivity is what counts here: points are any. Patches alternate in blocks.
Surface<3> surface_of(const specimens::Complex<2>& complex) {
    Surface<3> surface;
    surface.facets = complex.cells;
    for (std::size_t v = 0; v < complex.vertices; ++v) {
        surface.points.push_back({static_cast<double>(v), static_cast<double>(v * v), 1.0});
    }
    for (std::size_t f = 0; f < complex.cells.size(); ++f) {
        surface.patch.push_back(f < complex.cells.size() / 3 ? 4 : 2);
    }
    surface.patches = {{2, "shell"}, {4, "lid"}};
    return surface;
}

std::vector<specimens::Complex<2>> family() {
    using namespace specimens;
    std::vector<Complex<2>> members{sphere<2>(), refined(sphere<2>()), torus<2>(3), torus<2>(7),
                                    disjoint_union(sphere<2>(), torus<2>(4))};
    for (std::size_t k = members.size(); k-- > 0;) {
        members.push_back(shuffled(members[k], static_cast<unsigned>(k)));
    }
    return members;
}

void require_halfedges_right(const HalfedgeMesh& mesh) {
    for (const HalfedgeId h : mesh.halfedges()) {
        const HalfedgeId across = mesh.opposite(h);
        REQUIRE(mesh.opposite(across) == h);
        REQUIRE(mesh.from(across) == mesh.to(h));
        REQUIRE(mesh.facet(across) != mesh.facet(h));
        REQUIRE(mesh.edge(across) == mesh.edge(h));
        REQUIRE(mesh.previous(mesh.next(h)) == h);
        REQUIRE(mesh.from(mesh.next(h)) == mesh.to(h));
        REQUIRE(mesh.next(mesh.next(mesh.next(h))) == h);
        REQUIRE(mesh.facet(mesh.next(h)) == mesh.facet(h));
        REQUIRE(mesh.halfedge(mesh.from(h), mesh.to(h)) == h);
    }
    for (const EdgeId e : mesh.edges()) {
        const auto [a, b] = mesh.halfedges(e);
        REQUIRE(mesh.opposite(a) == b);
        REQUIRE(mesh.edge(a) == e);
        REQUIRE(mesh.facets(e) == std::array{mesh.facet(a), mesh.facet(b)});
        REQUIRE(mesh.vertices(e) == std::array{mesh.from(a), mesh.from(b)});
    }
}

void require_facets_right(const Boundary<3>& boundary, const Surface<3>& surface) {
    const HalfedgeMesh& mesh = boundary.mesh();
    const auto adjacency = build_adjacency<2>(surface.facets, surface.points.size());
    for (const FacetId f : mesh.facets()) {
        for (std::size_t i = 0; i < 3; ++i) {
            REQUIRE(mesh.vertices(f)[i].slot() == surface.facets[f.slot()][i]);
            REQUIRE(mesh.neighbors(f)[i].slot() == adjacency.neighbors[f.slot()][i]);
            REQUIRE(boundary.neighbors()[f.slot()][i] == adjacency.neighbors[f.slot()][i]);
            REQUIRE(mesh.facet(mesh.halfedges(f)[i]) == f);
            REQUIRE(mesh.from(mesh.halfedges(f)[i]) == mesh.vertices(f)[i]);
        }
        REQUIRE(boundary.patch()[f.slot()] == surface.patch[f.slot()]);
    }
}

/// Twins lead there and back, across the same vertices.
template<int D>
void require_twins_right(const Boundary<D>& boundary) {
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        for (std::size_t i = 0; i < D; ++i) {
            const TwinFacet twin = boundary.twin(f, i);
            const TwinFacet back = boundary.twin(twin.facet, twin.corner);
            REQUIRE(back.facet == f);
            REQUIRE(back.corner == i);
            std::set<Index> here(boundary.facets()[f].begin(), boundary.facets()[f].end());
            std::set<Index> there(boundary.facets()[twin.facet].begin(), boundary.facets()[twin.facet].end());
            here.erase(boundary.facets()[f][i]);
            there.erase(boundary.facets()[twin.facet][twin.corner]);
            REQUIRE(here == there);
            REQUIRE(boundary.owns(f, i) != boundary.owns(twin.facet, twin.corner));
            REQUIRE(boundary.facet_components().component(f) ==
                    boundary.facet_components().component(twin.facet));
        }
    }
}

/// Edges are numbered by their owners, then by the corner that they are opposite to.
void require_edges_in_order(const Boundary<3>& boundary) {
    Index next = 0;
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        const auto around = boundary.mesh().halfedges(FacetId{f});
        for (std::size_t i = 0; i < 3; ++i) {
            if (boundary.owns(f, i)) {
                REQUIRE(boundary.mesh().edge(around[(i + 1) % 3]).slot() == next++);
            }
        }
    }
    REQUIRE(next == boundary.ridge_count());
}

void require_stars_right(const HalfedgeMesh& mesh, const Surface<3>& surface) {
    for (const VertexId v : mesh.vertices()) {
        std::set<FacetId> facets;
        std::set<VertexId> around;
        for (const FacetId f : mesh.facets()) {
            if (std::ranges::count(surface.facets[f.slot()], v.slot()) > 0) {
                facets.insert(f);
                std::ranges::copy(mesh.vertices(f), std::inserter(around, around.end()));
            }
        }
        around.erase(v);
        const auto found = mesh.facets(v);
        REQUIRE(std::set(found.begin(), found.end()) == facets);
        const auto neighbors = mesh.neighbors(v);
        REQUIRE(std::set(neighbors.begin(), neighbors.end()) == around);
        const auto outgoing = mesh.outgoing(v);
        REQUIRE(outgoing.size() == neighbors.size());
        for (std::size_t k = 0; k < outgoing.size(); ++k) {
            REQUIRE(mesh.from(outgoing[k]) == v);
            const HalfedgeId clockwise = mesh.next(mesh.opposite(outgoing[k]));
            REQUIRE(outgoing[(k + 1) % outgoing.size()] == clockwise);
        }
    }
}

void require_refused(const Surface<3>& surface, const std::string& message,
                     const std::vector<Entity>& facets) {
    try {
        Boundary<3>{surface};
        FAIL("it was taken for a manifold");
    } catch (const GeometryError& error) {
        CHECK_THAT(error.what(), Contains(message));
        REQUIRE(error.entities.size() == facets.size());
        for (std::size_t k = 0; k < facets.size(); ++k) {
            CHECK(error.entities[k].kind == facets[k].kind);
            CHECK(error.entities[k].number == facets[k].number);
            CHECK(error.entities[k].patch == facets[k].patch);
        }
    }
}

} // namespace

TEST_CASE("half-edges, facets, stars and twins agree with the list of facets") {
    for (const auto& complex : family()) {
        const Surface<3> surface = surface_of(complex);
        const Boundary<3> boundary{surface};
        REQUIRE(boundary.facet_count() == surface.facets.size());
        REQUIRE(boundary.vertex_count() == surface.points.size());
        REQUIRE(2 * boundary.ridge_count() == 3 * boundary.facet_count());
        require_halfedges_right(boundary.mesh());
        require_facets_right(boundary, surface);
        require_stars_right(boundary.mesh(), surface);
        require_twins_right(boundary);
        require_edges_in_order(boundary);
    }
}

TEST_CASE("the boundary of a plane domain is a complex of its edges, with twins and components") {
    // A square, and a triangle inside it whose numbers are mixed with those of the square.
    const Surface<2> surface{{{0, 0}, {1, 1}, {4, 0}, {4, 4}, {2, 1}, {0, 4}, {1, 2}},
                             {{2, 0}, {1, 6}, {3, 2}, {5, 3}, {4, 1}, {0, 5}, {6, 4}},
                             {1, 7, 1, 1, 7, 2, 7},
                             {{1, "walls"}, {2, "inlet"}, {7, "body"}}};
    const Boundary<2> boundary{surface};
    require_twins_right(boundary);
    CHECK(boundary.ridge_count() == 7);
    CHECK(boundary.facet_components().facets() == std::vector<std::vector<Index>>{{0, 2, 3, 5}, {1, 4, 6}});
    CHECK(loops(boundary.mesh()).size() == 2);
    CHECK(boundary.vertices_of({7}) == std::vector<Index>{1, 4, 6});
    CHECK(boundary.vertices_of({2, 7}) == std::vector<Index>{0, 1, 4, 5, 6});
    CHECK_FALSE(boundary.on_crease(1, 0));
    CHECK(boundary.on_crease(5, 0)); // the inlet (0, 5), between walls
    CHECK(boundary.on_crease(5, 1));
    CHECK_FALSE(boundary.on_crease(2, 0));
}

TEST_CASE("a vertex in no facet has nothing around it") {
    auto complex = specimens::sphere<2>();
    ++complex.vertices;
    const Boundary<3> boundary{surface_of(complex)};
    CHECK(boundary.mesh().facets(VertexId{4}).empty());
    CHECK(boundary.mesh().neighbors(VertexId{4}).empty());
    CHECK_FALSE(boundary.mesh().halfedge(VertexId{4}, VertexId{0}).valid());
}

TEST_CASE("components are numbered by their first facet") {
    const auto two =
        specimens::shuffled(specimens::disjoint_union(specimens::sphere<2>(), specimens::torus<2>(4)), 3);
    const Boundary<3> boundary{surface_of(two)};
    const FacetComponents<3>& components = boundary.facet_components();
    REQUIRE(components.count() == 2);
    CHECK(components.first_facet(0) == 0);
    const std::vector<std::vector<Index>> facets = components.facets();
    CHECK(facets[0].size() + facets[1].size() == boundary.facet_count());
    for (Index c = 0; c < 2; ++c) {
        CHECK(facets[c].front() == components.first_facet(c));
        CHECK(std::ranges::all_of(facets[c], [&](Index f) { return components.component(f) == c; }));
    }
}

TEST_CASE("tracks, patches and ids are properties") {
    const Surface<3> surface = surface_of(specimens::sphere<2>());
    const Boundary<3> boundary{surface, {3, 2, 1, 0}};
    CHECK(boundary.tracks()[3] == 0);
    CHECK(boundary.start()[3] == surface.points[3]);
    CHECK(boundary.patches() == surface.patches);
    CHECK(std::ranges::equal(boundary.patch(), surface.patch));
    CHECK(boundary.persistent_ids().empty());

    const std::vector<PersistentId> ids{100, 101, 102, 103, 104, 105};
    const Boundary<3> placed = boundary.bounding(ids);
    CHECK(std::ranges::equal(placed.persistent_ids(), std::vector<PersistentId>{100, 101, 102, 103}));
    const Boundary<3> elsewhere = boundary.bounding(ids, {5, 0, 3, 1});
    CHECK(std::ranges::equal(elsewhere.persistent_ids(), std::vector<PersistentId>{105, 100, 103, 101}));
    CHECK(elsewhere.mesh_vertices()[2] == 3);
    CHECK(&elsewhere.mesh() == &boundary.mesh()); // shared

    CHECK(Boundary<3>{surface}.tracks()[2] == no_track);
    CHECK_THROWS_AS((Boundary<3>{surface, {1}}), UsageError);
    CHECK_THROWS_AS(boundary.bounding(ids, {5, 0, 3}), UsageError);
    CHECK_THROWS_WITH(boundary.bounding(ids, {5, 0, 3, 6}), Contains("vertex 6 of a mesh of 6"));
}

TEST_CASE("the rim of a patch falls into loops with the patch on their left") {
    // Two facets of the torus that do not touch, and two that touch in a vertex.
    const auto complex = specimens::torus<2>(6);
    Surface<3> surface = surface_of(complex);
    std::ranges::fill(surface.patch, 2);
    surface.patch[0] = surface.patch[40] = 4;
    const Boundary<3> apart{surface};
    std::size_t creases = 0;
    for (Index f = 0; f < apart.facet_count(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            creases += apart.owns(f, i) && apart.on_crease(f, i) ? 1 : 0;
        }
    }
    CHECK(creases == 6);
    const auto rims = apart.patch_loops(4);
    REQUIRE(rims.size() == 2);
    for (const auto& rim : rims) {
        REQUIRE(rim.size() == 3);
        for (std::size_t k = 0; k < 3; ++k) {
            const HalfedgeId h = apart.mesh().halfedge(VertexId{rim[k]}, VertexId{rim[(k + 1) % 3]});
            REQUIRE(h.valid());
            CHECK(apart.patch()[apart.mesh().facet(h).slot()] == 4);
        }
    }
    CHECK(apart.patch_loops(2).size() == 2);
    CHECK(apart.patch_loops(9).empty());

    const auto touching = [&] {
        for (std::size_t f = 1;; ++f) {
            const auto& a = surface.facets[0];
            const auto& b = surface.facets[f];
            if (std::ranges::count_if(b, [&](Index v) { return std::ranges::count(a, v) > 0; }) == 1) {
                return f;
            }
        }
    }();
    surface.patch[40] = 2;
    surface.patch[touching] = 4;
    const Boundary<3> pinched{surface};
    CHECK(pinched.patch_loops(4).size() == 2);
    CHECK(pinched.patch_loops(2).size() == 1); // around both
}

TEST_CASE("surfaces that are no closed manifold are refused, their facets and patches named") {
    auto open = specimens::sphere<2>();
    open.cells.pop_back();
    require_refused(surface_of(open), "is in 1 triangle: ",
                    {{"facet", 0, "lid"}, {"facet", 1, "shell"}, {"facet", 2, "shell"}});
    auto overfull = specimens::sphere<2>();
    overfull.cells.push_back({0, 1, 4});
    overfull.cells.push_back({1, 0, 4});
    overfull.vertices = 5;
    REQUIRE_THROWS_WITH(Boundary<3>{surface_of(overfull)}, Contains("edge (0, 1) is in 4 triangles"));
    auto turned = specimens::sphere<2>();
    specimens::flip(turned.cells[0]);
    REQUIRE_THROWS_WITH(Boundary<3>{surface_of(turned)}, Contains("disagree in orientation"));
    auto touching = specimens::disjoint_union(specimens::sphere<2>(), specimens::sphere<2>());
    specimens::merge_vertices(touching, 0, 4);
    REQUIRE_THROWS_WITH(Boundary<3>{surface_of(touching)},
                        Contains("triangles at vertex 0 do not form a fan"));
}
