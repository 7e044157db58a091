// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/prism_split.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace slabhull;

namespace {

template<int D>
using Cell = typename PrismTemplate<D>::Cell;

/// Position of a prism point times 12, so that it is exact: corner 0 of the facet at the origin, height 1.
template<int D>
std::array<long, D> position(int point) {
    std::array<long, D> sum{};
    const auto add = [&sum](int corner, long weight) {
        if (corner % D > 0) {
            sum[static_cast<std::size_t>(corner % D - 1)] += weight;
        }
        sum[D - 1] += corner >= D ? weight : 0;
    };
    std::vector<int> corners;
    for (int corner = 0; corner < 2 * D; ++corner) {
        const bool of_face = point >= 2 * D && point < 3 * D && corner % D != point - 2 * D;
        if (corner == point || of_face || point == 3 * D) {
            corners.push_back(corner);
        }
    }
    for (const int corner : corners) {
        add(corner, 12 / static_cast<long>(corners.size()));
    }
    return sum;
}

/// D! times the volume of a cell times 12^D: negative when its normal points out of the slab.
template<int D>
long scaled_volume(const Cell<D>& cell) {
    std::array<std::array<long, D>, D> e;
    for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t k = 0; k < D; ++k) {
            e[i][k] = position<D>(cell[i + 1])[k] - position<D>(cell[0])[k];
        }
    }
    if constexpr (D == 2) {
        return e[0][0] * e[1][1] - e[0][1] * e[1][0];
    } else {
        return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    }
}

template<int D>
constexpr long prism_volume = D == 2 ? 2 * 144 : 3 * 1728; // D! / (D-1)! times 12^D

template<int D>
using Key = std::array<std::uint8_t, D>;

template<int D>
std::map<Key<D>, int> facet_counts(const std::vector<Cell<D>>& cells) {
    std::map<Key<D>, int> counts;
    for (const Cell<D>& cell : cells) {
        for (std::size_t i = 0; i <= D; ++i) {
            Key<D> facet{};
            for (std::size_t k = 0, place = 0; k <= D; ++k) {
                if (k != i) {
                    facet[place++] = cell[k];
                }
            }
            std::sort(facet.begin(), facet.end());
            ++counts[facet];
        }
    }
    return counts;
}

/// The facets that a split must leave on the outside of the prism when every lateral face is centred (D = 3).
std::set<Key<3>> centred_prism_boundary() {
    std::set<Key<3>> facets{{0, 1, 2}, {3, 4, 5}};
    for (std::uint8_t i = 0; i < 3; ++i) {
        const auto j = static_cast<std::uint8_t>(i == 0 ? 1 : 0);
        const auto k = static_cast<std::uint8_t>(i == 2 ? 1 : 2);
        const std::array<std::uint8_t, 4> ring{j, k, static_cast<std::uint8_t>(k + 3),
                                               static_cast<std::uint8_t>(j + 3)};
        for (std::size_t side = 0; side < 4; ++side) {
            Key<3> facet{ring[side], ring[(side + 1) % 4], static_cast<std::uint8_t>(6 + i)};
            std::sort(facet.begin(), facet.end());
            facets.insert(facet);
        }
    }
    return facets;
}

/// What is wrong with a list of tetrahedra that should fill a prism with centred faces; empty when nothing is.
std::string faults_of_filling(const std::vector<Cell<3>>& cells) {
    std::string faults;
    long volume = 0;
    for (const Cell<3>& cell : cells) {
        volume += std::abs(scaled_volume<3>(cell));
    }
    if (volume != prism_volume<3>) {
        faults += "volume ";
    }
    std::set<Key<3>> outer;
    for (const auto& [facet, count] : facet_counts<3>(cells)) {
        if (count == 1) {
            outer.insert(facet);
        } else if (count > 2) {
            faults += "shared ";
        }
    }
    if (outer != centred_prism_boundary()) {
        faults += "boundary ";
    }
    return faults;
}

/// Tetrahedra in the paper's numbers 1 .. 10 (faces 7 of 2,3,5,6; 8 of 1,2,4,5; 9 of 1,3,4,6) in ours.
std::vector<Cell<3>> from_paper(const std::vector<std::array<int, 4>>& tets) {
    constexpr std::array<std::uint8_t, 11> ours{0, 0, 1, 2, 3, 4, 5, 6, 8, 7, 9};
    std::vector<Cell<3>> cells;
    for (const auto& tet : tets) {
        Cell<3>& cell = cells.emplace_back();
        std::transform(tet.begin(), tet.end(), cell.begin(),
                       [&](int point) { return ours[static_cast<std::size_t>(point)]; });
    }
    return cells;
}

std::set<std::set<std::uint8_t>> as_sets(const std::vector<Cell<3>>& cells) {
    std::set<std::set<std::uint8_t>> sets;
    for (const Cell<3>& cell : cells) {
        sets.emplace(cell.begin(), cell.end());
    }
    return sets;
}

const std::vector<std::array<int, 4>> paper_c{{1, 2, 3, 7}, {4, 5, 6, 7}, {1, 2, 7, 8}, {2, 5, 7, 8}, {4, 5, 7, 8},
                                              {1, 4, 7, 8}, {1, 3, 7, 9}, {3, 6, 7, 9}, {4, 6, 7, 9}, {1, 4, 7, 9}};

} // namespace

TEST_CASE("split C is the paper's list of ten tetrahedra", "[split]") {
    const auto& ours = template_of<3>(Split::C, {0, 1, 2});
    CHECK(as_sets(ours.cells) == as_sets(from_paper(paper_c)));
    CHECK(faults_of_filling(from_paper(paper_c)).empty());
}

TEST_CASE("splits C and E fill the prism exactly, with every lateral face centred", "[split]") {
    for (const Split split : {Split::C, Split::E}) {
        const auto& cells = template_of<3>(split, {2, 0, 1}).cells;
        CHECK(cells.size() == static_cast<std::size_t>(simplices_per_prism(split)));
        CHECK(faults_of_filling(cells).empty());
    }
}

TEST_CASE("a list that covers the quadrilaterals with both diagonals is found out", "[split]") {
    // The flaw of the paper's printed list for E: the centre joined to the two triangles of each diagonal instead of
    // to the four around the face centre.
    std::vector<std::array<int, 4>> flawed{{1, 2, 3, 10}, {4, 5, 6, 10}};
    for (const auto& [a, b, c, d] : {std::array{2, 3, 6, 5}, std::array{1, 2, 5, 4}, std::array{1, 3, 6, 4}}) {
        for (const auto& triangle : {std::array{a, b, c}, std::array{a, c, d}, std::array{a, b, d}, std::array{b, c, d}}) {
            flawed.push_back({triangle[0], triangle[1], triangle[2], 10});
        }
    }
    REQUIRE(flawed.size() == 14);
    const std::string faults = faults_of_filling(from_paper(flawed));
    CHECK(faults.find("volume") != std::string::npos);
    CHECK(faults.find("shared") != std::string::npos);
    CHECK(faults.find("boundary") != std::string::npos);
    long volume = 0;
    for (const Cell<3>& cell : from_paper(flawed)) {
        volume += std::abs(scaled_volume<3>(cell));
    }
    CHECK(3 * volume == 5 * prism_volume<3>); // 5/6 of a prism of volume 1/2, as 5/3 of it
}

TEST_CASE("every simplex of every split has its normal out of the slab", "[split]") {
    for (const Split split : {Split::C, Split::E}) {
        for (const auto& cell : template_of<3>(split, {0, 1, 2}).cells) {
            CHECK(scaled_volume<3>(cell) < 0);
        }
    }
    for (const Split split : {Split::centre, Split::diagonal}) {
        for (const auto& ids : {std::array<PersistentId, 2>{0, 1}, std::array<PersistentId, 2>{1, 0}}) {
            long volume = 0;
            for (const auto& cell : template_of<2>(split, ids).cells) {
                CHECK(scaled_volume<2>(cell) < 0);
                volume -= scaled_volume<2>(cell);
            }
            CHECK(volume == prism_volume<2>);
        }
    }
}

TEST_CASE("the diagonal of a quadrilateral starts at its vertex of smallest id", "[split]") {
    const auto has_diagonal = [](const PrismTemplate<2>& split, std::uint8_t a, std::uint8_t b) {
        return facet_counts<2>(split.cells)[{a, b}] == 2;
    };
    CHECK(has_diagonal(template_of<2>(Split::diagonal, {5, 9}), 0, 3));
    CHECK(has_diagonal(template_of<2>(Split::diagonal, {9, 5}), 1, 2));
}

TEST_CASE("a cone from any sound apex fills the prism, whatever its lateral faces carry", "[split]") {
    using enum LateralFace;
    const std::array all{centred, rising, falling};
    for (const LateralFace first : all) {
        for (const LateralFace second : all) {
            for (const LateralFace third : all) {
                long volume = 0;
                for (const auto& cell : cone_template<3>(PrismPoint<3>::centre, {first, second, third}).cells) {
                    volume -= scaled_volume<3>(cell);
                }
                CHECK(volume == prism_volume<3>);
            }
        }
    }
}

TEST_CASE("an unknown split is refused with the known ones named", "[split]") {
    CHECK(split_from_name("E", 3) == Split::E);
    CHECK_THROWS_WITH(split_from_name("E", 2), Catch::Contains("\"centre\"") && Catch::Contains("\"diagonal\""));
    CHECK_THROWS_AS(split_from_name("c", 3), UsageError);
}
