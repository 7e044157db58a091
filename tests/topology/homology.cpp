// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/homology.h"

#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/manifold.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

using namespace slabhull;
using specimens::Complex;

namespace {

template<int D>
BettiNumbers<D> betti(const Complex<D>& complex) {
    const auto adjacency = build_adjacency<D>(complex.cells, complex.vertices);
    REQUIRE(examine_manifold<D>(complex.cells, complex.vertices, adjacency).clean());
    return betti_numbers<D>(complex.cells, complex.vertices, adjacency.neighbors);
}

/// However it is numbered and refined.
template<int D>
void require_betti(const Complex<D>& complex, const BettiNumbers<D>& expected) {
    CHECK(betti(complex) == expected);
    CHECK(betti(specimens::refined(complex)) == expected);
    for (unsigned seed = 0; seed < 10; ++seed) {
        CHECK(betti(specimens::shuffled(complex, seed)) == expected);
    }
}

Complex<3> without_unused(Complex<3> complex) {
    std::vector<Index> number(complex.vertices, no_index);
    complex.vertices = 0;
    for (Simplex<3>& cell : complex.cells) {
        for (Index& v : cell) {
            if (number[v] == no_index) {
                number[v] = static_cast<Index>(complex.vertices++);
            }
            v = number[v];
        }
    }
    return complex;
}

/// A connected sum: a cell of each goes, and the holes are glued.
Complex<3> connected_sum(const Complex<3>& a, const Complex<3>& b) {
    Complex<3> joined = specimens::disjoint_union(a, b);
    Simplex<3> hole = joined.cells[0];
    Simplex<3> lid = joined.cells[a.cells.size()];
    joined.cells.erase(joined.cells.begin() + static_cast<std::ptrdiff_t>(a.cells.size()));
    joined.cells.erase(joined.cells.begin());
    specimens::flip(lid); // the holes face each other
    for (Simplex<3>& cell : joined.cells) {
        for (Index& v : cell) {
            const auto at = std::find(lid.begin(), lid.end(), v);
            v = at == lid.end() ? v : hole[static_cast<std::size_t>(at - lid.begin())];
        }
    }
    return without_unused(joined);
}

} // namespace

TEST_CASE("surfaces have the Betti numbers of their genus") {
    require_betti<2>(specimens::sphere<2>(), {1, 0, 1});
    require_betti<2>(specimens::torus<2>(4), {1, 2, 1});
    require_betti<2>(specimens::disjoint_union(specimens::torus<2>(3), specimens::sphere<2>()), {2, 2, 2});
}

TEST_CASE("3-manifolds have the Betti numbers of the textbooks") {
    require_betti<3>(specimens::sphere<3>(), {1, 0, 0, 1});
    require_betti<3>(specimens::suspension(specimens::sphere<2>()), {1, 0, 0, 1});
    require_betti<3>(specimens::times_circle(specimens::sphere<2>(), 3), {1, 1, 1, 1});
    require_betti<3>(specimens::torus<3>(3), {1, 3, 3, 1});
    require_betti<3>(specimens::times_circle(specimens::torus<2>(3), 3), {1, 3, 3, 1});
}

TEST_CASE("torsion of order two counts: projective space has b1 = 1 over Z/2") {
    require_betti<3>(specimens::projective_space(), {1, 1, 1, 1});
}

TEST_CASE("Betti numbers add up over disjoint unions and connected sums") {
    const auto ring = specimens::times_circle(specimens::sphere<2>(), 4);
    require_betti<3>(specimens::disjoint_union(specimens::torus<3>(3), specimens::projective_space()),
                     {2, 4, 4, 2});
    require_betti<3>(connected_sum(specimens::refined(ring), specimens::refined(specimens::torus<3>(3))),
                     {1, 4, 4, 1});
}

TEST_CASE("more critical cells than fit a machine word are handled") {
    auto sum = specimens::refined(specimens::torus<3>(3));
    for (int k = 0; k < 25; ++k) {
        sum = connected_sum(sum, specimens::refined(specimens::torus<3>(3)));
    }
    CHECK(betti(sum) == BettiNumbers<3>{1, 78, 78, 1});
}

TEST_CASE("a large sphere is reduced to a sphere") {
    auto sphere = specimens::sphere<3>();
    for (int k = 0; k < 6; ++k) {
        sphere = specimens::refined(sphere);
    }
    CHECK(betti(specimens::shuffled(sphere, 4)) == BettiNumbers<3>{1, 0, 0, 1});
}
