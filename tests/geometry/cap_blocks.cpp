// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_blocks.h"
#include "geometry/meshing/domain_blocks.h"
#include "geometry/meshing/domain_load.h"
#include "geometry/meshing/sliver_repair.h"
#include "geometry/meshing/surface_division.h"
#include "rooms.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

using namespace slabhull;
using namespace slabhull::specimens;

namespace {

SizeField<3> size_of(const Surface<3>& surface, const Grading& grading) {
    return {surface.points, boundary_spacing<3>(surface.points, surface.facets), grading};
}

/// A sphere in a cube, both with triangles of edge 1.2 / divisions.
Surface<3> sphere_in_cube(int divisions) {
    return join<3>(std::array{ellipsoid_body<3>({0, 0, 0}, {1, 1, 1}, divisions, {1, "sphere"}),
                              box_surface<3>({-3, -3, -3}, {3, 3, 3}, 1.2 / divisions, {2, "box"})});
}

CapOptions in_blocks(int blocks, double largest = std::numeric_limits<double>::infinity()) {
    CapOptions options;
    options.blocks = blocks;
    options.grading.largest = largest;
    return options;
}

DomainBlocks cut(const Surface<3>& surface, const Grading& grading, int count) {
    const SizeField<3> size = size_of(surface, grading);
    return cut_domain(Boundary<3>{surface}, surface, size, grading.growth, sample_load(surface, size), count);
}

double smallest_angle(const Array<Point<3>>& points, const Facet<3>& facet) {
    return dihedral_angles<2, 3>(corners_of<2, 3>(facet, points)).smallest;
}

} // namespace

TEST_CASE("the load of a domain of one spacing is its volume in cubes", "[blocks]") {
    const Surface<3> surface = with_bodies(cube(3, 6), {ball({0.5, 0, 0}, 1, 8)});
    const SizeField<3> size = size_of(surface, {0, 0.1});
    CHECK(cubes_in(sample_load(surface, size)) == Approx(enclosed(surface) / 0.001).epsilon(0.02));
}

TEST_CASE("the load of a graded domain is the integral of h^-3", "[blocks][long]") {
    const Surface<3> surface = with_bodies(cube(3, 4), {ball({0.5, 0, 0}, 1, 8)});
    const SizeField<3> size = size_of(surface, {0.3});
    constexpr int n = 150;
    constexpr double step = 6.0 / n;
    double sum = 0;
    for (int k = 0; k < n * n * n; ++k) {
        const Point<3> p{-3 + step * (k % n + 0.5), -3 + step * (k / n % n + 0.5),
                         -3 + step * (k / n / n + 0.5)};
        const double from_ball = std::hypot(p[0] - 0.5, p[1], p[2]);
        sum += from_ball > 1 ? std::pow(step / size(p), 3) : 0;
    }
    CHECK(cubes_in(sample_load(surface, size)) == Approx(sum).epsilon(0.1));
}

TEST_CASE("a surface is divided along a grid line, also when the plane is between two", "[blocks]") {
    const Surface<3> surface = box_surface<3>({0, 0, 0}, {8, 8, 8}, 1, {1, "box"});
    const Boundary<3> boundary{surface};
    const std::vector<double> spacing(surface.points.size(), 1.0);
    for (const double offset : {4.0, 4.2, 4.4, 4.6, 5.1}) {
        INFO(offset);
        std::vector<double> height;
        for (const Point<3>& p : surface.points) {
            height.push_back(p[0] - offset);
        }
        const auto above = divide_surface(surface, boundary.neighbors(), height, spacing);
        const Array<Facet<2>> rim = edges_between(surface, boundary.neighbors(), above);
        CHECK(rim.size() == 32);
        for (const Facet<2>& edge : rim) {
            CHECK(std::abs(height[edge[0]]) < 0.7);
            CHECK(surface.points[edge[0]][0] == surface.points[edge[1]][0]);
        }
    }
}

TEST_CASE("blocks are boundaries of domains that fill the domain together", "[blocks]") {
    for (const Room& room : rooms()) {
        for (const int count : {2, 3, 7}) {
            INFO(room.name << " in " << count);
            const DomainBlocks blocks = cut(room.boundary, {0.3}, count);
            double sum = 0;
            for (const Array<Facet<3>>& facets : blocks.facets) {
                const Surface<3> surface = surface_of_block(blocks.points, facets).surface;
                CHECK_NOTHROW(require_domain_boundary(surface, {}, false));
                CHECK(enclosed(surface) > 0);
                sum += enclosed(surface);
            }
            CHECK(sum == Approx(enclosed(room.boundary)).epsilon(1e-9));
            CHECK(
                std::equal(room.boundary.points.begin(), room.boundary.points.end(), blocks.points.begin()));
        }
    }
}

TEST_CASE("interfaces are in two blocks, once either way round, and well shaped", "[blocks]") {
    const Surface<3> surface = sphere_in_cube(6);
    const Grading grading{0.3, 0.2};
    const DomainBlocks blocks = cut(surface, grading, 4);
    REQUIRE(blocks.facets.size() == 4);
    std::map<Facet<3>, int> seen; // by vertices, turned so that the smallest is first
    std::size_t facets_in_all = 0;
    for (const Array<Facet<3>>& facets : blocks.facets) {
        facets_in_all += facets.size();
        for (Facet<3> facet : facets) {
            std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
            ++seen[facet];
        }
    }
    CHECK(seen.size() == facets_in_all);
    std::size_t inside = 0;
    double smallest = 180;
    for (const auto& [facet, times] : seen) {
        if (seen.count({facet[0], facet[2], facet[1]}) != 0) {
            ++inside;
            smallest = std::min(smallest, smallest_angle(blocks.points, facet));
        }
    }
    CHECK(facets_in_all == surface.facets.size() + inside);
    CHECK(inside > 2 * 3 * 900); // three squares of edge 6 with triangles of edge 0.2
    CHECK(smallest > 18);
}

TEST_CASE("blocks want equal shares, also of a load that is all in a corner", "[blocks]") {
    const Surface<3> surface = with_bodies(cube(3, 4), {ball({2, 2, 2}, 0.3, 8)});
    const SizeField<3> size = size_of(surface, {0.3});
    const DomainBlocks blocks = cut(surface, {0.3}, 2);
    REQUIRE(blocks.facets.size() == 2);
    const double all = cubes_in(sample_load(surface, size));
    for (const Array<Facet<3>>& facets : blocks.facets) {
        const double part = cubes_in(sample_load(surface_of_block(blocks.points, facets).surface, size));
        CHECK(part / all == Approx(0.5).margin(0.07));
    }
}

TEST_CASE("every room is filled in blocks, up to its boundary, which stays as it was", "[blocks][long]") {
    for (const Room& room : rooms()) {
        for (const int count : {2, 5}) {
            INFO(room.name << " in " << count);
            const CapMesh<3> mesh = mesh_cap(room.boundary, in_blocks(count));
            CHECK_NOTHROW(verify_cap(mesh, room.boundary));
            CHECK(volume(mesh) == Approx(enclosed(room.boundary)).epsilon(1e-9));
            Array<Point<3>> points = mesh.points;
            std::sort(points.begin(), points.end());
            CHECK(std::adjacent_find(points.begin(), points.end()) == points.end());
        }
    }
}

TEST_CASE("blocks cost neither angles nor many cells", "[blocks][long]") {
    const Surface<3> surface = sphere_in_cube(5);
    const CapMesh<3> whole = mesh_cap(surface, in_blocks(1, 0.24));
    CHECK(whole.blocks == 1);
    for (const int count : {2, 3, 8}) {
        const CapMesh<3> mesh = mesh_cap(surface, in_blocks(count, 0.24));
        CHECK(mesh.blocks == count);
        CHECK(smallest_dihedral(mesh) > 0.8 * smallest_dihedral(whole));
        CHECK(static_cast<double>(mesh.cells.size()) ==
              Approx(static_cast<double>(whole.cells.size())).epsilon(0.02));
    }
}

TEST_CASE("slivers are repaired where vertices may move, and fixed points stay", "[blocks][sliver]") {
    const Surface<3> surface = sphere_in_cube(4);
    CapMesh<3> mesh = mesh_cap(surface, in_blocks(1));
    // A vertex pushed towards a face of its star: the cell there is nearly flat.
    const auto flat = std::find_if(mesh.cells.begin(), mesh.cells.end(), [&](const Simplex<3>& cell) {
        return std::all_of(cell.begin(), cell.end(), [&](Index v) { return v >= surface.points.size(); });
    });
    REQUIRE(flat != mesh.cells.end());
    Point<3>& moved = mesh.points[(*flat)[0]];
    for (std::size_t k = 0; k < 3; ++k) {
        const double middle =
            (mesh.points[(*flat)[1]][k] + mesh.points[(*flat)[2]][k] + mesh.points[(*flat)[3]][k]) / 3;
        moved[k] += 0.99 * (middle - moved[k]);
    }
    REQUIRE(smallest_dihedral(mesh) < 3);
    CapMesh<3> held = mesh;
    repair_slivers(held, held.points.size(), 10);
    CHECK(held.points == mesh.points);
    repair_slivers(mesh, surface.points.size(), 10);
    CHECK(smallest_dihedral(mesh) > 8);
    CHECK_NOTHROW(verify_cap(mesh, surface));
}

TEST_CASE("blocks give the same bytes on any number of threads", "[blocks]") {
    const Surface<3> surface = sphere_in_cube(4);
    for (const bool curve : {true, false}) {
        CapOptions options = in_blocks(3);
        options.curve_order = curve;
        set_thread_count(1);
        const CapMesh<3> one = mesh_cap(surface, options);
        for (const int threads : {2, 5}) {
            set_thread_count(threads);
            const CapMesh<3> other = mesh_cap(surface, options);
            CHECK(one.points == other.points);
            CHECK(one.cells == other.cells);
            CHECK(one.neighbors == other.neighbors);
        }
        set_thread_count(0);
    }
}

/// A mesh in ranks, put together again; all ranks must have the same points.
CapMesh<3> meshed_in_ranks(const Surface<3>& surface, const CapOptions& options, int ranks,
                           std::vector<std::size_t>* counts = nullptr) {
    std::vector<CapMesh<3>> parts(static_cast<std::size_t>(ranks));
    run_team(ranks, [&](Communicator& team) {
        CapOptions in_team = options;
        in_team.ranks = &team;
        parts[static_cast<std::size_t>(team.rank())] = mesh_cap(surface, in_team);
    });
    CapMesh<3> whole;
    whole.points = parts.front().points;
    whole.blocks = parts.front().blocks;
    for (const CapMesh<3>& part : parts) {
        CHECK(part.points == whole.points);
        CHECK(part.blocks == whole.blocks);
        whole.cells.insert(whole.cells.end(), part.cells.begin(), part.cells.end());
        whole.neighbors.insert(whole.neighbors.end(), part.neighbors.begin(), part.neighbors.end());
        if (counts != nullptr) {
            counts->push_back(part.cells.size());
        }
    }
    return whole;
}

void require_same(const CapMesh<3>& one, const CapMesh<3>& other) {
    CHECK(one.blocks == other.blocks);
    CHECK(one.points == other.points);
    CHECK(one.cells == other.cells);
    CHECK(one.neighbors == other.neighbors);
}

TEST_CASE("ranks together mesh a cap as one process does in as many blocks", "[blocks][ranks]") {
    const Surface<3> surface = sphere_in_cube(4);
    for (const auto& [blocks, ranks] : {std::pair{2, 2}, {3, 2}, {7, 3}, {2, 5}, {1, 3}}) {
        for (const bool curve : {true, false}) {
            INFO(blocks << " blocks in " << ranks << " ranks" << (curve ? ", along the curve" : ""));
            CapOptions options = in_blocks(blocks);
            options.curve_order = curve;
            require_same(meshed_in_ranks(surface, options, ranks), mesh_cap(surface, options));
        }
    }
}

TEST_CASE("ranks repair the slivers that one process repairs", "[blocks][ranks][sliver]") {
    const Surface<3> surface = sphere_in_cube(4);
    CapOptions options = in_blocks(4);
    options.curve_order = false;
    options.min_dihedral = 0; // none
    const CapMesh<3> left = mesh_cap(surface, options);
    options.min_dihedral = 20;
    const CapMesh<3> repaired = mesh_cap(surface, options);
    REQUIRE(repaired.points != left.points);
    require_same(meshed_in_ranks(surface, options, 3), repaired);
}

TEST_CASE("ranks get about equally many cells of a cap, and all of one block are the first's",
          "[blocks][ranks]") {
    const Surface<3> surface = sphere_in_cube(5);
    std::vector<std::size_t> counts;
    const auto all = static_cast<double>(meshed_in_ranks(surface, in_blocks(2), 4, &counts).cells.size());
    for (const std::size_t count : counts) {
        CHECK(static_cast<double>(count) == Approx(all / 4).epsilon(0.01));
    }
    counts.clear();
    meshed_in_ranks(surface, in_blocks(1), 3, &counts);
    CHECK(counts.front() > 0);
    CHECK(counts == std::vector<std::size_t>{counts.front(), 0, 0});
}

TEST_CASE("ranks mesh small domains, too, and want a number of blocks", "[blocks][ranks]") {
    const Surface<3> surface = cube(1, 1); // 12 facets
    require_same(meshed_in_ranks(surface, in_blocks(64), 5), mesh_cap(surface, in_blocks(64)));
    CHECK_THROWS_AS(meshed_in_ranks(surface, in_blocks(0), 2), UsageError);
}

TEST_CASE("a domain too small to be cut is meshed whole", "[blocks]") {
    const Surface<3> surface = cube(1, 1);
    const CapMesh<3> mesh = mesh_cap(surface, in_blocks(64));
    CHECK_NOTHROW(verify_cap(mesh, surface));
    CHECK(mesh.blocks < 64);
}

TEST_CASE("memory decides how many blocks there are", "[blocks]") {
    CHECK(blocks_that_fit(SolidMesher::tetgen, 1e6, 1e9) == 1);
    CHECK(blocks_that_fit(SolidMesher::tetgen, 139e6, 24e9) > 1);
    int before = 1;
    for (const double bytes : {1e12, 40e9, 20e9, 16e9}) {
        const int blocks = blocks_that_fit(SolidMesher::tetgen, 100e6, bytes);
        CHECK(blocks >= before);
        before = blocks;
    }
    CHECK(blocks_that_fit(SolidMesher::hxt, 60e6, 20e9) > blocks_that_fit(SolidMesher::tetgen, 60e6, 20e9));
}

TEST_CASE("a number of blocks that makes no sense is refused", "[blocks][bad-input]") {
    CHECK_THROWS_AS(mesh_cap(cube(1, 1), in_blocks(-1)), UsageError);
    CHECK_THROWS_AS(mesh_cap(cube(1, 1), in_blocks(most_blocks + 1)), UsageError);
}
