// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/adjacency.h"

#include "slabhull/core/parallel.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

#include <map>

using namespace slabhull;
using specimens::Complex;

namespace {

template<int D>
Facet<D> sorted_facet(const Simplex<D>& cell, std::size_t i) {
    Facet<D> facet{};
    for (std::size_t k = 0, place = 0; k <= D; ++k) {
        if (k != i) {
            facet[place++] = cell[k];
        }
    }
    std::sort(facet.begin(), facet.end());
    return facet;
}

template<int D>
std::size_t place_of(const Neighbors<D>& neighbors, Index cell) {
    return static_cast<std::size_t>(std::find(neighbors.begin(), neighbors.end(), cell) - neighbors.begin());
}

template<int D>
void require_closed(const Complex<D>& complex) {
    const Adjacency<D> adjacency = build_adjacency<D>(complex.cells, complex.vertices);
    REQUIRE(adjacency.defects.empty());
    REQUIRE(adjacency.neighbors.size() == complex.cells.size());
    for (Index c = 0; c < complex.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index other = adjacency.neighbors[c][i];
            REQUIRE(other < complex.cells.size());
            const std::size_t back = place_of<D>(adjacency.neighbors[other], c);
            REQUIRE(back <= D);
            REQUIRE(sorted_facet<D>(complex.cells[c], i) == sorted_facet<D>(complex.cells[other], back));
        }
    }
}

/// The answer by the book: all sides of all facets in one map.
template<int D>
std::map<Facet<D>, std::vector<std::pair<Index, std::size_t>>> all_sides(const Array<Simplex<D>>& cells) {
    std::map<Facet<D>, std::vector<std::pair<Index, std::size_t>>> sides;
    for (Index c = 0; c < cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            sides[sorted_facet<D>(cells[c], i)].emplace_back(c, i);
        }
    }
    return sides;
}

template<int D>
void require_like_the_book(const Array<Simplex<D>>& cells, std::size_t vertices) {
    using Kind = typename FacetDefect<D>::Kind;
    const Adjacency<D> adjacency = build_adjacency<D>(cells, vertices);
    auto defect = adjacency.defects.begin();
    for (const auto& [facet, sides] : all_sides<D>(cells)) {
        const bool listed = defect != adjacency.defects.end() && defect->facet == facet;
        REQUIRE((listed || sides.size() == 2));
        for (const auto& [c, i] : sides) {
            const Index expected =
                sides.size() == 2 ? (sides[0] == std::pair{c, i} ? sides[1] : sides[0]).first : no_index;
            REQUIRE(adjacency.neighbors[c][i] == expected);
        }
        if (listed) {
            const Kind kind = sides.size() == 1   ? Kind::open
                              : sides.size() == 2 ? Kind::disoriented
                                                  : Kind::overfull;
            REQUIRE(defect->kind == kind);
            REQUIRE(defect->cells.size() == sides.size());
            ++defect;
        }
    }
    REQUIRE(defect == adjacency.defects.end());
}

template<int D>
Array<Simplex<D>> random_soup(std::size_t count, Index vertices, unsigned seed) {
    std::mt19937 random{seed};
    Array<Simplex<D>> cells(count);
    for (Simplex<D>& cell : cells) {
        for (Index& v : cell) {
            v = random() % vertices;
        }
    }
    return cells;
}

} // namespace

TEST_CASE("in a closed oriented complex, every facet joins two cells and nothing is reported") {
    require_closed(specimens::sphere<1>());
    require_closed(specimens::torus<1>(7));
    require_closed(specimens::sphere<2>());
    require_closed(specimens::torus<2>(5));
    require_closed(specimens::sphere<3>());
    require_closed(specimens::sphere<4>());
    require_closed(specimens::torus<3>(4));
    require_closed(specimens::projective_space());
    require_closed(specimens::times_circle(specimens::sphere<2>(), 3));
    require_closed(specimens::shuffled(specimens::refined(specimens::torus<3>(3)), 5));
}

TEST_CASE("any soup gets the neighbours and defects that a map of all facets gives") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        require_like_the_book<1>(random_soup<1>(40, 30, seed),
                                 30); // repeated vertices, overfull facets and all
        require_like_the_book<2>(random_soup<2>(60, 12, seed), 12);
        require_like_the_book<3>(random_soup<3>(200, 12, seed), 12);
        require_like_the_book<3>(random_soup<3>(900, 50, seed), 50); // several buckets
        require_like_the_book<4>(random_soup<4>(900, 40, seed), 40);
    }
    require_like_the_book<3>(random_soup<3>(30000, 60, 1), 60); // a bucket too large for hashing
    require_like_the_book<4>(random_soup<4>(20000, 60, 1), 60);
}

TEST_CASE("a missing cell leaves its facets open, and only them") {
    auto complex = specimens::torus<3>(3);
    const Simplex<3> gone = complex.cells[17];
    complex.cells.erase(complex.cells.begin() + 17);
    const auto adjacency = build_adjacency<3>(complex.cells, complex.vertices);
    REQUIRE(adjacency.defects.size() == 4);
    for (const auto& defect : adjacency.defects) {
        CHECK(defect.kind == FacetDefect<3>::Kind::open);
        CHECK(defect.cells.size() == 1);
        for (const Index v : defect.facet) {
            CHECK(std::find(gone.begin(), gone.end(), v) != gone.end());
        }
    }
}

TEST_CASE("a reversed cell disagrees with all its neighbours and stays joined to them") {
    auto complex = specimens::torus<3>(4);
    const auto sound = build_adjacency<3>(complex.cells, complex.vertices);
    std::swap(complex.cells[100][0], complex.cells[100][1]);
    auto adjacency = build_adjacency<3>(complex.cells, complex.vertices);
    REQUIRE(adjacency.defects.size() == 4);
    for (const auto& defect : adjacency.defects) {
        CHECK(defect.kind == FacetDefect<3>::Kind::disoriented);
        CHECK(std::count(defect.cells.begin(), defect.cells.end(), Index{100}) == 1);
    }
    std::swap(adjacency.neighbors[100][0], adjacency.neighbors[100][1]);
    CHECK(adjacency.neighbors == sound.neighbors);
}

TEST_CASE("a facet in four cells is overfull, even when they would pair up") {
    const Array<Simplex<2>> cells{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}};
    const auto adjacency = build_adjacency<2>(cells, 6);
    CHECK(adjacency.defects.front().kind == FacetDefect<2>::Kind::overfull);
    CHECK(adjacency.defects.front().facet == Facet<2>{0, 1});
    CHECK(adjacency.defects.front().cells == std::vector<Index>{0, 1, 2, 3});
    CHECK(adjacency.neighbors[0][2] == no_index);
}

TEST_CASE("an apex of very many cells is matched in near-linear time") {
    const auto complex = specimens::suspension(specimens::torus<2>(150)); // 45,000 cells at each apex
    require_closed(complex);
    require_closed(specimens::shuffled(complex, 3));
}

TEST_CASE("no cells have no neighbours") {
    CHECK(build_adjacency<3>({}, 0).neighbors.empty());
    CHECK(build_adjacency<2>({}, 5).defects.empty());
}

TEST_CASE("the adjacency does not depend on the number of threads") {
    const auto soup = random_soup<3>(20000, 4000, 1);
    const auto complex = specimens::torus<3>(24);
    set_thread_count(1);
    const auto soup_alone = build_adjacency<3>(soup, 4000);
    const auto alone = build_adjacency<3>(complex.cells, complex.vertices);
    set_thread_count(4);
    const auto soup_together = build_adjacency<3>(soup, 4000);
    const auto together = build_adjacency<3>(complex.cells, complex.vertices);
    set_thread_count(0);
    CHECK(alone.neighbors == together.neighbors);
    CHECK(soup_alone.neighbors == soup_together.neighbors);
    REQUIRE(soup_alone.defects.size() == soup_together.defects.size());
    for (std::size_t k = 0; k < soup_alone.defects.size(); ++k) {
        REQUIRE(soup_alone.defects[k].cells == soup_together.defects[k].cells);
        REQUIRE(soup_alone.defects[k].facet == soup_together.defects[k].facet);
    }
}
