// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/matching.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/topology/adjacency.h"
#include "specimens.h"

#include <catch2/catch.hpp>

using namespace slabhull;
using specimens::Complex;

namespace {

Array<Neighbors<2>> neighbors_of(const Complex<2>& surface) {
    return build_adjacency<2>(surface.cells, surface.vertices).neighbors;
}

bool perfect(const Array<Index>& mate, const Array<Neighbors<2>>& neighbors) {
    for (Index f = 0; f < neighbors.size(); ++f) {
        const auto& across = neighbors[f];
        if (mate[f] >= mate.size() || mate[mate[f]] != f ||
            std::find(across.begin(), across.end(), mate[f]) == across.end()) {
            return false;
        }
    }
    return true;
}

/// A ring of `count` triangular sections: long and thin, so that paths between distant triangles must be
/// long.
Complex<2> long_ring(Index count) {
    Complex<2> ring{{}, 3 * count};
    for (Index section = 0; section < count; ++section) {
        for (Index i = 0; i < 3; ++i) {
            const Index a = 3 * section + i;
            const Index b = 3 * section + (i + 1) % 3;
            const Index next = 3 * ((section + 1) % count) - 3 * section;
            ring.cells.push_back({a, b, b + next});
            ring.cells.push_back({a, b + next, a + next});
        }
    }
    return ring;
}

Complex<2> refined_often(Complex<2> surface, int times) {
    for (int i = 0; i < times; ++i) {
        surface = specimens::refined<2>(surface);
    }
    return surface;
}

} // namespace

TEST_CASE("every closed surface has its triangles paired with a neighbour each", "[matching]") {
    using namespace specimens;
    const std::vector<Complex<2>> family{
        sphere<2>(),
        refined<2>(sphere<2>()),
        refined_often(sphere<2>(), 8),
        torus<2>(3),
        torus<2>(31),
        refined_often(torus<2>(5), 3),
        long_ring(3),
        long_ring(4001),
        disjoint_union<2>(torus<2>(7), disjoint_union<2>(sphere<2>(), refined_often(sphere<2>(), 5))),
    };
    for (const Complex<2>& surface : family) {
        for (unsigned seed = 0; seed < 4; ++seed) {
            const auto neighbors = neighbors_of(seed == 0 ? surface : shuffled<2>(surface, seed));
            REQUIRE(perfect(perfect_matching(neighbors), neighbors));
        }
    }
}

TEST_CASE("large surfaces in any numbering are matched without a long wait", "[matching]") {
    const auto surface = specimens::shuffled<2>(specimens::torus<2>(220), 5);
    const auto neighbors = neighbors_of(surface);
    CHECK(perfect(perfect_matching(neighbors), neighbors));
}

TEST_CASE("the matching depends on the numbering of the triangles alone", "[matching]") {
    const auto surface = refined_often(specimens::torus<2>(9), 2);
    const auto neighbors = neighbors_of(surface);
    const auto mate = perfect_matching(neighbors);
    auto renumbered = surface; // vertices backwards: the triangles keep their numbers
    for (auto& cell : renumbered.cells) {
        for (Index& v : cell) {
            v = static_cast<Index>(surface.vertices) - 1 - v;
        }
    }
    CHECK(perfect_matching(neighbors_of(renumbered)) == mate);
    set_thread_count(1);
    CHECK(perfect_matching(neighbors) == mate);
    set_thread_count(0);
}

TEST_CASE("a surface that cannot be matched is refused with the triangles left over", "[matching]") {
    auto open = specimens::sphere<2>();
    open.cells.pop_back(); // three triangles around a vertex: one is left over
    try {
        perfect_matching(neighbors_of(open));
        FAIL("no exception");
    } catch (const GeometryError& error) {
        CHECK(error.entities.size() == 1);
        CHECK_THAT(error.what(), Catch::Contains("closed"));
    }
    const Array<Neighbors<2>> alone(3, Neighbors<2>{no_index, no_index, no_index});
    CHECK_THROWS_AS(perfect_matching(alone), GeometryError);
}

TEST_CASE("two triangles that no alternating path joins are refused on a large surface too", "[matching]") {
    auto open = specimens::torus<2>(190); // its dual graph is bipartite: cells of even and of odd number
    open.cells.erase(open.cells.begin() + 2000);
    open.cells.erase(open.cells.begin() + 1000);
    try {
        perfect_matching(neighbors_of(open));
        FAIL("no exception");
    } catch (const GeometryError& error) {
        CHECK(error.entities.size() == 2);
    }
}

TEST_CASE("nothing to match is no error", "[matching]") {
    CHECK(perfect_matching({}).empty());
}
