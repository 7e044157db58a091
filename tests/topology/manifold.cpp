// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/manifold.h"

#include "slabhull/core/parallel.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

#include <random>

using namespace slabhull;
using specimens::Complex;

namespace {

template<int D>
ManifoldReport examine(const Complex<D>& complex, const ManifoldOptions& options = {}) {
    const auto adjacency = build_adjacency<D>(complex.cells, complex.vertices);
    const ManifoldReport report = examine_manifold<D>(complex.cells, complex.vertices, adjacency, options);
    const auto confirmed = confirm_manifold<D>(complex.cells, complex.vertices, adjacency.neighbors);
    REQUIRE(confirmed.has_value() == report.clean());
    if (confirmed) {
        REQUIRE(confirmed->counts.vertices == report.counts.vertices);
        REQUIRE(confirmed->counts.edges == report.counts.edges);
        REQUIRE(confirmed->counts.facets == report.counts.facets);
        REQUIRE(confirmed->counts.components == report.counts.components);
        REQUIRE(confirmed->counts.euler == report.counts.euler);
    }
    return report;
}

template<int D>
bool confirms(const Complex<D>& complex, const Array<Neighbors<D>>& claimed) {
    return confirm_manifold<D>(complex.cells, complex.vertices, claimed).has_value();
}

/// Exchanges what is across facet i of cell c with what is across facet j of cell d.
template<int D>
void cross(Array<Neighbors<D>>& neighbors, std::array<Index, 2> first, std::array<Index, 2> second,
           const std::array<std::size_t, 4>& places) {
    const auto [a, b] = first;
    const auto [c, d] = second;
    neighbors[a][places[0]] = d;
    neighbors[d][places[3]] = a;
    neighbors[c][places[2]] = b;
    neighbors[b][places[1]] = c;
}

/// Findings of one kind, so many, and no others.
void require_only(const ManifoldReport& report, ManifoldDefect what, std::size_t times) {
    for (std::size_t kind = 0; kind < manifold_defect_kinds; ++kind) {
        CAPTURE(kind);
        REQUIRE(report.found[kind] == (kind == static_cast<std::size_t>(what) ? times : 0));
    }
    REQUIRE(report.findings.size() == times);
    for (const ManifoldFinding& finding : report.findings) {
        REQUIRE(finding.what == what);
        REQUIRE_FALSE(finding.detail.empty());
    }
}

template<int D>
void require_manifold(const Complex<D>& complex, std::int64_t euler, std::size_t components) {
    for (const Complex<D>& variant :
         {complex, specimens::shuffled(complex, 11), specimens::refined(complex)}) {
        const ManifoldReport report = examine(variant);
        REQUIRE(report.clean());
        CHECK(report.findings.empty());
        CHECK(report.counts.euler == euler);
        CHECK(report.counts.components == components);
        CHECK(report.counts.vertices == variant.vertices);
        CHECK(2 * report.counts.facets == (D + 1) * variant.cells.size()); // 3F = 2E, F = 2T
    }
}

} // namespace

TEST_CASE("manifolds are found clean, with their Euler characteristic") {
    require_manifold(specimens::sphere<2>(), 2, 1);
    require_manifold(specimens::torus<2>(4), 0, 1);
    require_manifold(specimens::disjoint_union(specimens::sphere<2>(), specimens::torus<2>(3)), 2, 2);
    require_manifold(specimens::sphere<3>(), 0, 1);
    require_manifold(specimens::torus<3>(3), 0, 1);
    require_manifold(specimens::projective_space(), 0, 1);
    require_manifold(specimens::times_circle(specimens::sphere<2>(), 4), 0, 1);
    require_manifold(specimens::suspension(specimens::sphere<2>()), 0, 1);
    require_manifold(specimens::disjoint_union(specimens::sphere<3>(), specimens::torus<3>(3)), 0, 2);
}

TEST_CASE("edges and facets of the 3-torus are counted as known") {
    const ManifoldCounts counts = examine(specimens::torus<3>(5)).counts;
    CHECK(counts.vertices == 125);
    CHECK(counts.edges == 7 * 125);
    CHECK(counts.facets == 12 * 125);
    CHECK(counts.cells == 6 * 125);
}

TEST_CASE("edges are counted where the links are not spheres, too") {
    // V - E + F - T of a suspension is 2 - chi of its base; that of a wedge is the sum less one.
    CHECK(examine(specimens::suspension(specimens::torus<2>(4))).counts.euler == 2);
    auto wedge = specimens::disjoint_union(specimens::sphere<3>(), specimens::torus<3>(3));
    specimens::merge_vertices(wedge, 0, 7);
    CHECK(examine(wedge).counts.euler == -1);
    auto holed = specimens::torus<3>(3);
    holed.cells.erase(holed.cells.begin());
    CHECK(examine(holed).counts.euler == 1);
}

TEST_CASE("a cell that names a vertex twice is blamed once, its facets by those of its neighbours") {
    auto complex = specimens::torus<3>(4);
    complex.cells.push_back({3, 3, 5, 9});
    const ManifoldReport report = examine(complex);
    REQUIRE(report.count(ManifoldDefect::repeated_vertex) == 1);
    CHECK(report.findings.front().cells == std::vector<Index>{384});
    CHECK(report.count(ManifoldDefect::singular_vertex) == 0);

    auto surface = specimens::torus<2>(4);
    surface.cells.push_back({surface.cells[0][0], surface.cells[0][0], surface.cells[0][1]});
    require_only(examine(surface), ManifoldDefect::repeated_vertex, 1);
}

TEST_CASE("a duplicated cell is found, and its overfull facets are not blamed") {
    auto complex = specimens::torus<3>(4);
    complex.cells.push_back(complex.cells[33]);
    const ManifoldReport report = examine(complex);
    require_only(report, ManifoldDefect::duplicate_cell, 1);
    CHECK(report.findings.front().cells == std::vector<Index>{384, 33});

    auto surface = specimens::torus<2>(4);
    surface.cells.push_back({surface.cells[7][1], surface.cells[7][0], surface.cells[7][2]}); // reversed
    require_only(examine(surface), ManifoldDefect::duplicate_cell, 1);
}

TEST_CASE("two cells glued along all their facets are duplicates") {
    const Complex<3> pillow{{{0, 1, 2, 3}, {1, 0, 2, 3}}, 4};
    require_only(examine(pillow), ManifoldDefect::duplicate_cell, 1);
}

TEST_CASE("vertices in no cell are found") {
    auto complex = specimens::torus<3>(3);
    complex.vertices += 2;
    const ManifoldReport report = examine(complex);
    require_only(report, ManifoldDefect::unused_vertex, 2);
    CHECK(report.findings[1].vertices == std::vector<Index>{28});
    CHECK(report.counts.vertices == 27);
}

TEST_CASE("a hole is found as open facets, without blame for its vertices") {
    auto complex = specimens::torus<3>(4);
    complex.cells.erase(complex.cells.begin() + 5);
    require_only(examine(complex), ManifoldDefect::open_facet, 4);
    auto surface = specimens::torus<2>(4);
    surface.cells.erase(surface.cells.begin() + 5);
    require_only(examine(surface), ManifoldDefect::open_facet, 3);
}

TEST_CASE("three cells on a facet are found") {
    auto surface = specimens::disjoint_union(specimens::sphere<2>(), specimens::sphere<2>());
    specimens::merge_vertices(surface, 0, 7);
    specimens::merge_vertices(surface, 1, 6); // two spheres with a common edge
    const ManifoldReport report = examine(surface);
    require_only(report, ManifoldDefect::overfull_facet, 1);
    CHECK(report.findings.front().vertices == std::vector<Index>{0, 1});
    CHECK(report.findings.front().cells.size() == 4);
}

TEST_CASE("a reversed cell is found by its disoriented facets") {
    auto complex = specimens::torus<3>(4);
    specimens::flip(complex.cells[50]);
    require_only(examine(complex), ManifoldDefect::disoriented_facet, 4);
    auto surface = specimens::torus<2>(4);
    specimens::flip(surface.cells[9]);
    require_only(examine(surface), ManifoldDefect::disoriented_facet, 3);
}

TEST_CASE("two spheres that touch in a point are found at the point") {
    auto surfaces =
        specimens::disjoint_union(specimens::sphere<2>(), specimens::refined(specimens::sphere<2>()));
    specimens::merge_vertices(surfaces, 2, 5);
    require_only(examine(surfaces), ManifoldDefect::singular_vertex, 1);

    auto hulls =
        specimens::disjoint_union(specimens::sphere<3>(), specimens::refined(specimens::sphere<3>()));
    specimens::merge_vertices(hulls, 2, 6);
    const ManifoldReport report = examine(hulls);
    require_only(report, ManifoldDefect::singular_vertex, 1);
    CHECK(report.findings.front().vertices == std::vector<Index>{2});
}

TEST_CASE("a cone over a torus is found, though its link is connected and closed") {
    const ManifoldReport report =
        examine(specimens::shuffled(specimens::suspension(specimens::torus<2>(5)), 2));
    require_only(report, ManifoldDefect::singular_vertex, 2);
    CHECK(report.findings.front().detail.find("Euler characteristic 0") != std::string::npos);
}

TEST_CASE("two spheres that touch along an edge are blamed for the edge alone") {
    auto hulls =
        specimens::disjoint_union(specimens::refined(specimens::sphere<3>()), specimens::sphere<3>());
    specimens::merge_vertices(hulls, 1, 11);
    specimens::merge_vertices(hulls, 3, 10);
    const ManifoldReport report = examine(hulls);
    require_only(report, ManifoldDefect::singular_edge, 1);
    CHECK(report.findings.front().vertices == std::vector<Index>{1, 3});
}

TEST_CASE("a link of two spheres touching twice is found, though its Euler characteristic is 2") {
    const auto ball = specimens::refined(specimens::sphere<3>());
    auto hulls = specimens::disjoint_union(ball, ball);
    for (const Index v : {7u, 6u, 0u}) { // 6 and 7 are centres of cells at 0, not joined by an edge
        specimens::merge_vertices(hulls, v, static_cast<Index>(ball.vertices) + v);
    }
    const ManifoldReport report = examine(specimens::shuffled(hulls, 8));
    require_only(report, ManifoldDefect::singular_edge, 2);
}

TEMPLATE_TEST_CASE_SIG("claimed neighbours are confirmed when each is right, and only then", "", ((int D), D),
                       2, 3) {
    // more vertices than are looked at at once, in an order that follows space and in none
    const auto ordered = specimens::torus<D>(D == 2 ? 280 : 43);
    for (const Complex<D>& complex : {ordered, specimens::shuffled(ordered, 3)}) {
        auto claimed = build_adjacency<D>(complex.cells, complex.vertices).neighbors;
        REQUIRE(confirms<D>(complex, claimed));
        std::mt19937 random{7};
        for (int k = 0; k < 12; ++k) {
            Index& entry = claimed[random() % claimed.size()][random() % (D + 1)];
            const Index right = entry;
            entry = k % 3 == 0 ? no_index : static_cast<Index>(random() % claimed.size());
            REQUIRE_FALSE(confirms<D>(complex, claimed));
            entry = right;
        }
        std::swap(claimed[5][0], claimed[5][1]);
        REQUIRE_FALSE(confirms<D>(complex, claimed));
        std::swap(claimed[5][0], claimed[5][1]);
        claimed.pop_back();
        REQUIRE_FALSE(confirms<D>(complex, claimed));
    }
}

TEST_CASE("neighbours that pair the four cells of a facet by twos are not confirmed, though all links are "
          "spheres") {
    // Two spheres with a facet in common: opened there and glued crosswise, each vertex has one whole star.
    Complex<2> surfaces{
        {{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {1, 0, 5}, {0, 4, 5}, {1, 5, 4}}, 6};
    auto around = build_adjacency<2>(surfaces.cells, surfaces.vertices).neighbors;
    REQUIRE(around[0][2] == no_index);
    cross<2>(around, {0, 1}, {4, 5}, {2, 2, 2, 2});
    CHECK_FALSE(confirms<2>(surfaces, around));

    Complex<3> spheres{{}, 7};
    for (const std::array<Index, 5>& v :
         {std::array<Index, 5>{0, 1, 2, 3, 4}, std::array<Index, 5>{0, 1, 2, 5, 6}}) {
        // The boundary of a 4-simplex; the first two cells are those at facet 0, 1, 2.
        spheres.cells.insert(spheres.cells.end(), {{v[0], v[1], v[2], v[3]},
                                                   {v[1], v[0], v[2], v[4]},
                                                   {v[0], v[1], v[3], v[4]},
                                                   {v[2], v[0], v[3], v[4]},
                                                   {v[1], v[2], v[3], v[4]}});
    }
    auto beside = build_adjacency<3>(spheres.cells, spheres.vertices).neighbors;
    REQUIRE(beside[0][3] == no_index);
    REQUIRE(build_adjacency<3>(spheres.cells, spheres.vertices).defects.size() == 1);
    cross<3>(beside, {0, 1}, {5, 6}, {3, 3, 3, 3});
    CHECK_FALSE(confirms<3>(spheres, beside));
    for (const Index shift : {0u, 5u}) { // each sphere alone, in the same numbers, is fine
        Complex<3> alone{{spheres.cells.begin() + shift, spheres.cells.begin() + shift + 5}, 7};
        for (Simplex<3>& cell : alone.cells) {
            for (Index& vertex : cell) {
                vertex -= vertex > 4 ? 2 : 0;
            }
        }
        alone.vertices = 5;
        CHECK(confirms<3>(alone, build_adjacency<3>(alone.cells, 5).neighbors));
    }
}

TEST_CASE("at most so many findings of a kind are kept, and all are counted") {
    auto complex = specimens::torus<3>(3);
    complex.vertices += 1000;
    const ManifoldReport report = examine(complex, {7});
    CHECK(report.count(ManifoldDefect::unused_vertex) == 1000);
    CHECK(report.findings.size() == 7);
}

TEST_CASE("random soups are examined without end or crash, the same for any number of threads") {
    for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random{seed};
        Complex<3> soup{Array<Simplex<3>>(300), 5 + random() % 60};
        for (Simplex<3>& cell : soup.cells) {
            for (Index& v : cell) {
                v = static_cast<Index>(random() % soup.vertices);
            }
        }
        set_thread_count(1);
        const ManifoldReport alone = examine(soup);
        set_thread_count(4);
        const ManifoldReport together = examine(soup);
        set_thread_count(0);
        REQUIRE(alone.found == together.found);
        REQUIRE(alone.counts.euler == together.counts.euler);
        REQUIRE(alone.findings.size() == together.findings.size());
        for (std::size_t k = 0; k < alone.findings.size(); ++k) {
            REQUIRE(alone.findings[k].vertices == together.findings[k].vertices);
            REQUIRE(alone.findings[k].cells == together.findings[k].cells);
        }
    }
}
