// SPDX-License-Identifier: BSD-3-Clause
#include "rooms.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"

#include <catch2/catch.hpp>

#include <string>

using namespace slabhull;
using namespace slabhull::specimens;
using Catch::Matchers::Contains;

namespace {

CapOptions with_hxt(int blocks = 1) {
    CapOptions options;
    options.mesher = SolidMesher::hxt;
    options.blocks = blocks;
    return options;
}

} // namespace

TEST_CASE("a build without Gmsh says so", "[without-gmsh]") {
    if (!has_mesher(SolidMesher::hxt)) {
        CHECK_THROWS_AS(mesh_cap(cube(1, 2), with_hxt()), UsageError);
        CHECK_THROWS_WITH(mesh_cap(cube(1, 2), with_hxt()), Contains("SLABHULL_GMSH"));
    }
}

TEST_CASE("HXT fills every room up to its boundary, whole and in blocks", "[hxt]") {
    if (!has_mesher(SolidMesher::hxt)) {
        WARN("this build is without Gmsh");
        return;
    }
    for (const Room& room : rooms()) {
        for (const int blocks : {1, 3}) {
            INFO(room.name << " in " << blocks);
            const CapMesh<3> mesh = mesh_cap(room.boundary, with_hxt(blocks));
            CHECK_NOTHROW(verify_cap(mesh, room.boundary));
            CHECK(volume(mesh) == Approx(enclosed(room.boundary)).epsilon(1e-9));
        }
    }
}

TEST_CASE("HXT follows the size field and leaves no small angles", "[hxt]") {
    if (!has_mesher(SolidMesher::hxt)) {
        return;
    }
    const Surface<3> surface = with_bodies(cube(5, 16), {ball({0, 0, 0}, 1, 6)});
    CapOptions options = with_hxt();
    const CapMesh<3> mesh = mesh_cap(surface, options);
    CHECK(smallest_dihedral(mesh) > 8);
    options.mesher = SolidMesher::tetgen;
    const auto cells = static_cast<double>(mesh_cap(surface, options).cells.size());
    CHECK(static_cast<double>(mesh.cells.size()) == Approx(cells).epsilon(0.3));
    options.mesher = SolidMesher::hxt;
    options.grading.largest = 0.3;
    CHECK(mesh_cap(surface, options).cells.size() > 2 * mesh.cells.size());
}

TEST_CASE("two runs of HXT give the same bytes", "[hxt]") {
    if (!has_mesher(SolidMesher::hxt)) {
        return;
    }
    const Surface<3> surface = small_room().boundary;
    const CapMesh<3> one = mesh_cap(surface, with_hxt());
    const CapMesh<3> two = mesh_cap(surface, with_hxt());
    CHECK(one.points == two.points);
    CHECK(one.cells == two.cells);
    CHECK(one.neighbors == two.neighbors);
}
