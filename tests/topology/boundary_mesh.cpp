// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/boundary_mesh.h"

#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/hull_openmesh.h"
#include "topology/specimens.h"

#include <OpenMesh/Core/Utils/PropertyManager.hh>
#include <catch2/catch.hpp>

#include <algorithm>
#include <concepts>
#include <set>
#include <utility>

using namespace slabhull;
using Catch::Contains;

template<class Argument>
concept has_facets_at = requires(const BoundaryMesh& mesh, Argument argument) {
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

void require_halfedges_right(const BoundaryMesh& mesh) {
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

void require_facets_right(const BoundaryMesh& mesh, const Surface<3>& surface) {
    const auto adjacency = build_adjacency<2>(surface.facets, surface.points.size());
    for (const FacetId f : mesh.facets()) {
        for (std::size_t i = 0; i < 3; ++i) {
            REQUIRE(mesh.vertices(f)[i].slot() == surface.facets[f.slot()][i]);
            REQUIRE(mesh.neighbors(f)[i].slot() == adjacency.neighbors[f.slot()][i]);
            REQUIRE(mesh.facet(mesh.halfedges(f)[i]) == f);
            REQUIRE(mesh.from(mesh.halfedges(f)[i]) == mesh.vertices(f)[i]);
        }
        REQUIRE(mesh.patch(f) == surface.patch[f.slot()]);
    }
}

void require_stars_right(const BoundaryMesh& mesh, const Surface<3>& surface) {
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
        BoundaryMesh{surface};
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

/// Two caps, each a triangle, and a side of three squares in four triangles between times 2 and 3: a hull.
Hull<2> small_hull() {
    Hull<2> hull;
    hull.points = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {0, 0, 3}, {1, 0, 3}, {0, 1, 3}};
    hull.cells = {{0, 2, 1}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}, {3, 4, 5}};
    hull.neighbors = build_adjacency<2>(hull.cells, hull.points.size()).neighbors;
    hull.vertex_ids = {10, 11, 12, 13, 14, 15};
    hull.track_ids = {0, 1, 2, 0, 1, 2};
    hull.initial_cells = 1;
    hull.side_cells = 6;
    hull.layers = 1;
    hull.cells_per_prism = 2;
    hull.facet_patch = {1, 3, 1};
    return hull;
}

} // namespace

TEST_CASE("half-edges, facets and stars agree with the list of facets") {
    for (const auto& complex : family()) {
        const Surface<3> surface = surface_of(complex);
        const BoundaryMesh mesh{surface};
        REQUIRE(mesh.facet_count() == surface.facets.size());
        REQUIRE(mesh.vertex_count() == surface.points.size());
        REQUIRE(2 * mesh.edge_count() == 3 * mesh.facet_count());
        require_halfedges_right(mesh);
        require_facets_right(mesh, surface);
        require_stars_right(mesh, surface);
    }
}

TEST_CASE("a vertex in no facet has nothing around it") {
    auto complex = specimens::sphere<2>();
    ++complex.vertices;
    const BoundaryMesh mesh{surface_of(complex)};
    CHECK(mesh.facets(VertexId{4}).empty());
    CHECK(mesh.neighbors(VertexId{4}).empty());
    CHECK_FALSE(mesh.halfedge(VertexId{4}, VertexId{0}).valid());
}

TEST_CASE("ids, tracks and patches are properties") {
    const Surface<3> surface = surface_of(specimens::sphere<2>());
    const std::vector<PersistentId> ids{100, 101, 102, 103};
    const std::vector<TrackId> tracks{3, 2, 1, 0};
    BoundaryMesh mesh{surface, ids, tracks};
    CHECK(mesh.persistent_id(VertexId{2}) == 102);
    CHECK(mesh.track(VertexId{3}) == 0);
    CHECK(mesh.point(VertexId{3}) == surface.points[3]);
    mesh.move(VertexId{3}, {7, 8, 9});
    mesh.facet_patches()[1] = 4;
    const BoundaryMesh moved = std::move(mesh);
    CHECK(moved.point(VertexId{3}) == Point<3>{7, 8, 9});
    CHECK(moved.patch(FacetId{1}) == 4);
    CHECK(moved.patches() == surface.patches);

    const BoundaryMesh plain{surface};
    CHECK(plain.persistent_id(VertexId{2}) == 2);
    CHECK(plain.track(VertexId{2}) == no_track);
    CHECK_THROWS_AS((BoundaryMesh{surface, std::vector<PersistentId>{1}}), UsageError);
}

TEST_CASE("the border of a patch falls into loops with the patch on their left") {
    // Two facets of the torus that do not touch, and two that touch in a vertex.
    const auto complex = specimens::torus<2>(6);
    Surface<3> surface = surface_of(complex);
    std::ranges::fill(surface.patch, 2);
    surface.patch[0] = surface.patch[40] = 4;
    const BoundaryMesh apart{surface};
    CHECK(apart.patch_border().size() == 6);
    const auto loops = apart.patch_loops(4);
    REQUIRE(loops.size() == 2);
    for (const auto& loop : loops) {
        REQUIRE(loop.size() == 3);
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(apart.patch(apart.facet(loop[k])) == 4);
            CHECK(apart.to(loop[k]) == apart.from(loop[(k + 1) % 3]));
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
    const BoundaryMesh pinched{surface};
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
    REQUIRE_THROWS_WITH(BoundaryMesh{surface_of(overfull)}, Contains("edge (0, 1) is in 4 triangles"));
    auto turned = specimens::sphere<2>();
    specimens::flip(turned.cells[0]);
    REQUIRE_THROWS_WITH(BoundaryMesh{surface_of(turned)}, Contains("disagree in orientation"));
    auto touching = specimens::disjoint_union(specimens::sphere<2>(), specimens::sphere<2>());
    specimens::merge_vertices(touching, 0, 4);
    REQUIRE_THROWS_WITH(BoundaryMesh{surface_of(touching)},
                        Contains("triangles at vertex 0 do not form a fan"));
}

TEST_CASE("the hull of a plane domain opens as an OpenMesh mesh with its properties") {
    const Hull<2> hull = small_hull();
    const HullOpenMesh mesh = to_openmesh(hull);
    REQUIRE(mesh.n_faces() == 8);
    REQUIRE(mesh.n_vertices() == 6);
    CHECK(mesh.n_edges() == 12);
    auto& ids = mesh.property(OpenMesh::getProperty<OpenMesh::VertexHandle, PersistentId>(
                                  const_cast<HullOpenMesh&>(mesh), vertex_id_property)
                                  .getRawProperty());
    CHECK(ids[4] == 14);
    for (const auto v : mesh.vertices()) {
        const Point<3>& p = hull.points[static_cast<std::size_t>(v.idx())];
        CHECK(mesh.point(v) == OpenMesh::Vec3d(p[0], p[1], p[2]));
    }
    for (const auto f : mesh.faces()) {
        std::set<Index> corners;
        for (const auto v : f.vertices()) {
            corners.insert(static_cast<Index>(v.idx()));
        }
        const auto& cell = hull.cells[static_cast<std::size_t>(f.idx())];
        CHECK(corners == std::set<Index>(cell.begin(), cell.end()));
    }
}

TEST_CASE("every property of a hull is found by its name and type") {
    const Hull<2> hull = small_hull();
    HullOpenMesh mesh = to_openmesh(hull);
    const auto tracks = OpenMesh::getProperty<OpenMesh::VertexHandle, TrackId>(mesh, track_id_property);
    const auto region = OpenMesh::getProperty<OpenMesh::FaceHandle, Region>(mesh, region_property);
    const auto patch = OpenMesh::getProperty<OpenMesh::FaceHandle, PatchNumber>(mesh, patch_property);
    const auto layer = OpenMesh::getProperty<OpenMesh::FaceHandle, int>(mesh, layer_property);
    for (const auto v : mesh.vertices()) {
        CHECK(tracks[v] == hull.track_ids[static_cast<std::size_t>(v.idx())]);
    }
    for (const auto f : mesh.faces()) {
        const auto cell = static_cast<std::size_t>(f.idx());
        CHECK(region[f] == hull.region(cell));
        CHECK(patch[f] == hull.patch(cell));
        CHECK(layer[f] == hull.layer(cell));
    }
}

TEST_CASE("a hull with a hole does not open") {
    Hull<2> hull = small_hull();
    hull.cells.pop_back();
    REQUIRE_THROWS_WITH(to_openmesh(hull), Contains("is in 1 triangle"));
}
