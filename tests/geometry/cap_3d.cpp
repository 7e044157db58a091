// SPDX-License-Identifier: BSD-3-Clause
#include "rooms.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/adjacency.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace slabhull;
using namespace slabhull::specimens;
using Catch::Matchers::Contains;

TEST_CASE("every room is filled up to its boundary, which stays as it was", "[cap]") {
    for (const Room& room : rooms()) {
        INFO(room.name);
        REQUIRE_NOTHROW(require_domain_boundary(room.boundary, {}, true));
        const CapMesh<3> mesh = mesh_cap(room.boundary, {});

        CHECK_NOTHROW(verify_cap(mesh, room.boundary));
        CHECK(volume(mesh) == Approx(enclosed(room.boundary)).epsilon(1e-9));
        CHECK(mesh.cells.size() > room.boundary.facets.size() / 2);
    }
}

TEST_CASE("cells of a well-shaped boundary have no small angles", "[cap]") {
    CHECK(smallest_dihedral(mesh_cap(with_bodies(cube(5, 12), {ball({0, 0, 0}, 1, 4)}), {})) > 5);
}

TEST_CASE("two runs give the same bytes", "[cap]") {
    const Surface<3> boundary = small_room().boundary;
    const CapMesh<3> one = mesh_cap(boundary, {});
    const CapMesh<3> two = mesh_cap(boundary, {});
    CHECK(one.points == two.points);
    CHECK(one.cells == two.cells);
    CHECK(one.neighbors == two.neighbors);
}

TEST_CASE("the mean edge follows the largest size asked for", "[cap]") {
    const Surface<3> boundary =
        cube(1, 4); // cells on the wall stay as large as its facets: leave room for others
    std::size_t before = mesh_cap(boundary, {}).cells.size();
    for (const double largest : {0.4, 0.2, 0.1}) {
        CapOptions options;
        options.grading.largest = largest;
        const CapMesh<3> mesh = mesh_cap(boundary, options);
        CHECK(mesh.cells.size() > 2 * before);
        before = mesh.cells.size();
    }
}

TEST_CASE("slower growth makes more cells", "[cap]") {
    const Surface<3> boundary = with_bodies(cube(5, 4), {ball({0, 0, 0}, 0.5, 6)});
    const auto cells = [&](double growth) {
        CapOptions options;
        options.grading.growth = growth;
        return mesh_cap(boundary, options).cells.size();
    };
    CHECK(cells(0.15) > 2 * cells(0.6));
}

TEST_CASE("moved and scaled rooms are meshed as well", "[cap]") {
    const Surface<3> boundary = small_room().boundary;
    for (const double scale : {1e-6, 1e6}) {
        const Surface<3> moved = mapped(boundary, [scale](Point<3> p) {
            return Point<3>{scale * (p[0] + 3), scale * (p[1] - 2), scale * p[2]};
        });
        CHECK(volume(mesh_cap(moved, {})) == Approx(enclosed(moved)).epsilon(1e-9));
    }
}

TEST_CASE("a surface that would crash the mesher becomes an error", "[cap][bad-input]") {
    const auto room = small_room().boundary;
    SECTION("crossing itself") {
        const auto crossing = with_bodies(cube(2, 4), {ball({0, 0, 0}, 1, 4), ball({0.7, 0.1, 0.2}, 1, 4)});
        CHECK_THROWS_AS(mesh_cap(crossing, {}), GeometryError);
    }
    SECTION("a body through the wall") {
        CHECK_THROWS_AS(mesh_cap(with_bodies(cube(2, 4), {ball({1.9, 0, 0}, 0.5, 4)}), {}), GeometryError);
    }
    SECTION("two triangles through each other in a closed surface") {
        auto dented = cube(1, 4);
        dented.points[dented.facets[0][0]] = {3, 3, 3};
        CHECK_THROWS_AS(mesh_cap(dented, {}), GeometryError);
    }
    SECTION("not a number") {
        auto broken = room;
        broken.points[5][1] = std::numeric_limits<double>::quiet_NaN();
        CHECK_THROWS_WITH(mesh_cap(broken, {}), Contains("finite"));
    }
    SECTION("a hole in the surface") {
        auto open = room;
        open.facets.pop_back();
        open.patch.pop_back();
        CHECK_THROWS_WITH(mesh_cap(open, {}), Contains("open"));
    }
    SECTION("coincident vertices") {
        auto double_point = room;
        double_point.points[1] = double_point.points[0];
        CHECK_THROWS_AS(mesh_cap(double_point, {}), GeometryError);
    }
    SECTION("a vertex that is not there") {
        auto wild = room;
        wild.facets[3][1] = 1'000'000;
        CHECK_THROWS_WITH(mesh_cap(wild, {}), Contains("vertex 1000000"));
    }
    SECTION("nothing at all") {
        CHECK_THROWS_AS(mesh_cap(Surface<3>{}, {}), GeometryError);
    }
    SECTION("only a body, oriented inwards") {
        CHECK_THROWS_AS(mesh_cap(turned_inside_out(ball({0, 0, 0}, 1, 3)), {}), GeometryError);
    }
    SECTION("all points in a plane") {
        CHECK_THROWS_AS(mesh_cap(mapped(cube(1, 2),
                                        [](Point<3> p) {
                                            return Point<3>{p[0], p[1], 0};
                                        }),
                                 {}),
                        GeometryError);
    }
}

TEST_CASE("senseless quality bounds are refused before any work", "[cap][bad-input]") {
    CapOptions options;
    options.radius_edge = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(mesh_cap(cube(1, 1), options), UsageError);
    options = {};
    options.min_dihedral = 70;
    CHECK_THROWS_AS(mesh_cap(cube(1, 1), options), UsageError);
}

namespace {

/// The same mesh with a vertex put on an edge of the boundary: the cells around the edge are cut in two.
CapMesh<3> with_split_boundary(CapMesh<3> mesh, Index a, Index b) {
    Point<3> middle;
    for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = 0.5 * (mesh.points[a][k] + mesh.points[b][k]);
    }
    const auto fresh = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(middle);
    const std::size_t before = mesh.cells.size();
    for (std::size_t c = 0; c < before; ++c) {
        Simplex<3> other = mesh.cells[c];
        const auto at_a = std::find(mesh.cells[c].begin(), mesh.cells[c].end(), a);
        const auto at_b = std::find(other.begin(), other.end(), b);
        if (at_a != mesh.cells[c].end() && at_b != other.end()) {
            *at_a = fresh;
            *at_b = fresh;
            mesh.cells.push_back(other);
        }
    }
    mesh.neighbors = build_adjacency<3>(mesh.cells, mesh.points.size()).neighbors;
    return mesh;
}

/// The same mesh with a vertex replaced by a copy of it.
CapMesh<3> with_copied_vertex(CapMesh<3> mesh, Index vertex) {
    const auto copy = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(mesh.points[vertex]);
    for (Simplex<3>& cell : mesh.cells) {
        std::replace(cell.begin(), cell.end(), vertex, copy);
    }
    return mesh;
}

} // namespace

TEST_CASE("verification finds planted faults", "[cap][verify]") {
    const Surface<3> surface = small_room().boundary;
    CapMesh<3> mesh = mesh_cap(surface, {});
    REQUIRE_NOTHROW(verify_cap(mesh, surface));
    Surface<3> other = surface;

    SECTION("a facet asked for that the mesh does not have") {
        other.facets[7] = {other.facets[7][0], other.facets[7][1], other.facets[20][2]};
        CHECK_THROWS_WITH(verify_cap(mesh, other), Contains("lacks 1 of") && Contains("facet 7 (patch box)"));
    }
    SECTION("a facet asked for the other way round") {
        std::swap(other.facets[7][0], other.facets[7][1]);
        CHECK_THROWS_WITH(verify_cap(mesh, other), Contains("lacks 1 of") && Contains("has 1 others"));
    }
    SECTION("the other diagonal of two facets, with the same vertices and counts") {
        const auto [a, b, c] = surface.facets[0]; // facets 0 and 1 share a and c
        const Index d = surface.facets[1][2];
        other.facets[0] = {a, b, d};
        other.facets[1] = {b, c, d};
        CHECK_THROWS_WITH(verify_cap(mesh, other), Contains("lacks 2 of") && Contains("has 2 others"));
    }
    SECTION("a facet missing in the surface") {
        other.facets.pop_back();
        CHECK_THROWS_WITH(verify_cap(mesh, other), Contains("lacks 0 of") && Contains("has 1 others"));
    }
    SECTION("a facet wanted twice") {
        other.facets.push_back(other.facets[0]);
        other.patch.push_back(other.patch[0]);
        CHECK_THROWS_WITH(verify_cap(mesh, other), Contains("lacks 1 of"));
    }
    SECTION("a vertex replaced by its copy") {
        CHECK_THROWS_WITH(verify_cap(with_copied_vertex(mesh, surface.facets[0][0]), surface),
                          Contains("lacks"));
    }
    SECTION("a vertex added on an edge of the boundary") {
        const CapMesh<3> split = with_split_boundary(mesh, surface.facets[0][0], surface.facets[0][1]);
        CHECK_THROWS_WITH(verify_cap(split, surface), Contains("lacks 2 of") && Contains("has 4 others"));
    }
    SECTION("a given point moved by the last bit") {
        mesh.points[3][0] = std::nextafter(mesh.points[3][0], 10);
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("vertex 3 of the surface"));
    }
    SECTION("a cell turned inside out") {
        std::swap(mesh.cells[11][0], mesh.cells[11][1]);
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("inside out") && Contains("cell 11"));
    }
    SECTION("an interior point pushed through its cells") {
        REQUIRE(mesh.points.size() > surface.points.size());
        mesh.points.back() = {100, 100, 100};
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("inside out"));
    }
    SECTION("neighbours of two facets exchanged") {
        auto& neighbors = mesh.neighbors[5];
        std::swap(neighbors[0], neighbors[1]);
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("neighbours"));
    }
    SECTION("a cell removed") {
        mesh.cells.pop_back();
        mesh.neighbors.pop_back();
        CHECK_THROWS_AS(verify_cap(mesh, surface), GeometryError);
    }
    SECTION("a cell that refers to a point that is not there") {
        mesh.cells[2][3] = static_cast<Index>(mesh.points.size());
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("do not exist"));
    }
    SECTION("a point that no cell uses") {
        mesh.points.push_back({0, 0, 1.5});
        CHECK_THROWS_WITH(verify_cap(mesh, surface), Contains("no cell uses"));
    }
    SECTION("no cells") {
        CHECK_THROWS_WITH(verify_cap(CapMesh<3>{}, surface), Contains("empty"));
    }
}
