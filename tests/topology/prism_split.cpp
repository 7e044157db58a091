// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/prism_split.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <optional>
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
        return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
               e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    }
}

template<int D>
constexpr long prism_volume = D == 2 ? 2 * 144 : 3 * 1728; // D! / (D-1)! times 12^D

template<int D>
using Key = std::array<std::uint8_t, D>;

template<int D>
Key<D> sorted(Key<D> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
}

template<int D>
Key<D> facet_of(const Cell<D>& cell, std::size_t left_out) {
    Key<D> facet{};
    for (std::size_t k = 0, place = 0; k <= D; ++k) {
        if (k != left_out) {
            facet[place++] = cell[k];
        }
    }
    return sorted<D>(facet);
}

template<int D>
std::map<Key<D>, int> facet_counts(const std::vector<Cell<D>>& cells) {
    std::map<Key<D>, int> counts;
    for (const Cell<D>& cell : cells) {
        for (std::size_t i = 0; i <= D; ++i) {
            ++counts[facet_of<D>(cell, i)];
        }
    }
    return counts;
}

/// The facet in an outer slot of a template; none where the slot is empty.
std::optional<Key<3>> facet_in_slot(const PrismTemplate<3>& filling, std::uint8_t slot) {
    for (std::size_t c = 0; c < filling.cells.size(); ++c) {
        for (std::size_t i = 0; i < 4; ++i) {
            if (filling.across[c][i] == PrismTemplate<3>::outside + slot) {
                return facet_of<3>(filling.cells[c], i);
            }
        }
    }
    return {};
}

std::uint8_t as_byte(std::size_t value) {
    return static_cast<std::uint8_t>(value);
}

/// The facets that a split must leave on the outside of the prism, for what its quadrilaterals carry.
template<int D>
std::set<Key<D>> agreed_boundary(const Quads<D>& quads) {
    if constexpr (D == 2) {
        return {{0, 1}, {2, 3}, {0, 2}, {1, 3}};
    } else {
        std::set<Key<3>> facets{{0, 1, 2}, {3, 4, 5}};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint8_t j = i == 0 ? 1 : 0;
            const std::uint8_t k = i == 2 ? 1 : 2;
            const auto above = [](std::uint8_t corner) { return as_byte(corner + 3u); };
            if (quads[i] == Quad::centred) {
                const std::uint8_t centre = as_byte(6 + i);
                facets.insert({{j, k, centre},
                               {above(j), above(k), centre},
                               {j, above(j), centre},
                               {k, above(k), centre}});
            } else {
                const std::uint8_t low = quads[i] == Quad::rising ? j : k;
                const std::uint8_t high = above(quads[i] == Quad::rising ? k : j);
                facets.insert(sorted<3>({j, k, high}));
                facets.insert(sorted<3>({low, above(j), above(k)}));
            }
        }
        return facets;
    }
}

/// What is wrong with a list of simplices that should fill a prism; empty when nothing is.
template<int D>
std::string faults_of_filling(const std::vector<Cell<D>>& cells, const Quads<D>& quads) {
    std::string faults;
    long volume = 0;
    for (const Cell<D>& cell : cells) {
        volume += std::abs(scaled_volume<D>(cell));
    }
    if (volume != prism_volume<D>) {
        faults += "volume ";
    }
    std::set<Key<D>> outer;
    for (const auto& [facet, count] : facet_counts<D>(cells)) {
        if (count == 1) {
            outer.insert(facet);
        } else if (count > 2) {
            faults += "shared ";
        }
    }
    if (outer != agreed_boundary<D>(quads)) {
        faults += "boundary ";
    }
    return faults;
}

constexpr Quads<3> all_centred{};

template<int D>
std::vector<Quads<D>> all_quads() {
    std::vector<Quads<D>> all{{}};
    for (std::size_t q = 0; q < std::tuple_size_v<Quads<D>>; ++q) {
        std::vector<Quads<D>> longer;
        for (Quads<D> quads : all) {
            for (const Quad quad : {Quad::centred, Quad::rising, Quad::falling}) {
                quads[q] = quad;
                longer.push_back(quads);
            }
        }
        all = std::move(longer);
    }
    return all;
}

template<int D>
const PrismTemplate<D>& template_for(Split split, const Quads<D>& quads) {
    return templates_of<D>(split)[template_number<D>(quads)];
}

/// Calls visit(split, quads, template) for every template that there is.
template<int D, class Visit>
void each_template(const Visit& visit) {
    for (const std::string_view name : D == 2 ? std::vector<std::string_view>{"diagonal", "centre"}
                                              : std::vector<std::string_view>{"A", "B", "C", "D", "E"}) {
        const Split split = split_from_name(name, D);
        for (const Quads<D>& quads : all_quads<D>()) {
            if (!template_for<D>(split, quads).cells.empty()) {
                INFO(name << " " << int{template_number<D>(quads)});
                visit(split, quads, template_for<D>(split, quads));
            }
        }
    }
}

template<int D>
std::set<std::set<std::uint8_t>> as_sets(const std::vector<Cell<D>>& cells) {
    std::set<std::set<std::uint8_t>> sets;
    for (const Cell<D>& cell : cells) {
        sets.emplace(cell.begin(), cell.end());
    }
    return sets;
}

/// A symmetry of the prism: column i goes to column[i], and time may run backwards.
template<int D>
struct Symmetry {
    std::array<std::size_t, D> column;
    bool backwards;

    std::uint8_t operator()(std::size_t point) const {
        if (point < 2 * D) {
            return as_byte(column[point % D] + ((point < D) == backwards ? D : 0));
        }
        return as_byte(point < 3 * D ? 2 * D + column[point - 2 * D] : point);
    }
    std::vector<Cell<D>> operator()(std::vector<Cell<D>> cells) const {
        for (Cell<D>& cell : cells) {
            std::transform(cell.begin(), cell.end(), cell.begin(),
                           [this](std::uint8_t p) { return (*this)(p); });
        }
        return cells;
    }
    Quads<D> operator()(const Quads<D>& quads) const {
        Quads<D> result;
        for (std::size_t q = 0; q < quads.size(); ++q) {
            const auto [j, k] = quad_corners<D>(q);
            const std::size_t to = D == 2 ? 0 : column[q];
            const bool turned = (column[j] > column[k]) != backwards;
            const Quad other = quads[q] == Quad::rising ? Quad::falling : Quad::rising;
            result[to] = quads[q] != Quad::centred && turned ? other : quads[q];
        }
        return result;
    }
};

template<int D>
std::vector<Symmetry<D>> all_symmetries() {
    std::vector<Symmetry<D>> all;
    std::array<std::size_t, D> column{};
    std::iota(column.begin(), column.end(), std::size_t{0});
    do {
        all.push_back({column, false});
        all.push_back({column, true});
    } while (std::next_permutation(column.begin(), column.end()));
    return all;
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

const std::vector<std::array<int, 4>> paper_c{{1, 2, 3, 7}, {4, 5, 6, 7}, {1, 2, 7, 8}, {2, 5, 7, 8},
                                              {4, 5, 7, 8}, {1, 4, 7, 8}, {1, 3, 7, 9}, {3, 6, 7, 9},
                                              {4, 6, 7, 9}, {1, 4, 7, 9}};

} // namespace

TEST_CASE("split C is the paper's list of ten tetrahedra", "[split]") {
    CHECK(as_sets<3>(template_for<3>(Split::C, all_centred).cells) == as_sets<3>(from_paper(paper_c)));
    CHECK(faults_of_filling<3>(from_paper(paper_c), all_centred).empty());
}

TEST_CASE("a list that covers the quadrilaterals with both diagonals is found out", "[split]") {
    // The flaw of the paper's printed list for E: the centre joined to the two triangles of each diagonal
    // instead of to the four around the face centre.
    std::vector<std::array<int, 4>> flawed{{1, 2, 3, 10}, {4, 5, 6, 10}};
    for (const auto& [a, b, c, d] :
         {std::array{2, 3, 6, 5}, std::array{1, 2, 5, 4}, std::array{1, 3, 6, 4}}) {
        for (const auto& triangle :
             {std::array{a, b, c}, std::array{a, c, d}, std::array{a, b, d}, std::array{b, c, d}}) {
            flawed.push_back({triangle[0], triangle[1], triangle[2], 10});
        }
    }
    REQUIRE(flawed.size() == 14);
    const std::string faults = faults_of_filling<3>(from_paper(flawed), all_centred);
    CHECK(faults.find("volume") != std::string::npos);
    CHECK(faults.find("shared") != std::string::npos);
    CHECK(faults.find("boundary") != std::string::npos);
    long volume = 0;
    for (const Cell<3>& cell : from_paper(flawed)) {
        volume += std::abs(scaled_volume<3>(cell));
    }
    CHECK(3 * volume == 5 * prism_volume<3>); // 5/6 of a prism of volume 1/2, as 5/3 of it
}

TEST_CASE("splits make 3, 6, 10, 12 and 14 tetrahedra, 2 and 4 triangles, for the quadrilaterals they allow",
          "[split]") {
    std::map<Split, int> combinations;
    each_template<2>([&](Split split, const auto&, const auto&) { ++combinations[split]; });
    each_template<3>([&](Split split, const auto&, const auto& filling) {
        ++combinations[split];
        CHECK(filling.cells.size() == static_cast<std::size_t>(simplices_per_prism(split)));
    });
    const std::map<Split, int> simplices{{Split::diagonal, 2}, {Split::centre, 4}, {Split::A, 3},
                                         {Split::B, 6},        {Split::C, 10},     {Split::D, 12},
                                         {Split::E, 14}};
    for (const auto& [split, count] : simplices) {
        CHECK(simplices_per_prism(split) == count);
    }
    // A: all but the two cycles. B: the centred quadrilateral, two diagonals. D: the place of its one
    // diagonal.
    CHECK(combinations == std::map<Split, int>{{Split::diagonal, 2},
                                               {Split::centre, 1},
                                               {Split::A, 6},
                                               {Split::B, 12},
                                               {Split::C, 1},
                                               {Split::D, 6},
                                               {Split::E, 1}});
}

TEMPLATE_TEST_CASE_SIG(
    "every template fills the prism exactly, with the outer facets agreed on, normals out of the slab",
    "[split]", ((int D), D), 2, 3) {
    each_template<D>([](Split, const Quads<D>& quads, const PrismTemplate<D>& filling) {
        CHECK(faults_of_filling<D>(filling.cells, quads).empty());
        for (const Cell<D>& cell : filling.cells) {
            CHECK(scaled_volume<D>(cell) < 0);
        }
    });
}

TEMPLATE_TEST_CASE_SIG("templates go over into sound ones under every symmetry of the prism", "[split]",
                       ((int D), D), 2, 3) {
    each_template<D>([](Split split, const Quads<D>& quads, const PrismTemplate<D>& filling) {
        for (const Symmetry<D>& symmetry : all_symmetries<D>()) {
            const auto image = symmetry(filling.cells);
            CHECK(faults_of_filling<D>(image, symmetry(quads)).empty());
            if (split != Split::C) { // whose apex is one of three equal centres
                CHECK(as_sets<D>(image) == as_sets<D>(template_for<D>(split, symmetry(quads)).cells));
            }
        }
    });
}

TEMPLATE_TEST_CASE_SIG("the adjacency of a template is that of its facets", "[split]", ((int D), D), 2, 3) {
    using Template = PrismTemplate<D>;
    each_template<D>([](Split, const Quads<D>&, const Template& filling) {
        std::map<int, int> found; // slots
        for (std::size_t c = 0; c < filling.cells.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                const int across = filling.across[c][i];
                const auto facet = facet_of<D>(filling.cells[c], i);
                if (across >= Template::outside) {
                    CHECK(facet_counts<D>(filling.cells)[facet] == 1);
                    CHECK(filling.cell_at[static_cast<std::size_t>(across - Template::outside)] == c);
                    ++found[across - Template::outside];
                    continue;
                }
                REQUIRE(static_cast<std::size_t>(across) < filling.cells.size());
                CHECK(static_cast<std::size_t>(across) != c);
                const auto& there = filling.cells[static_cast<std::size_t>(across)];
                bool shared = false;
                for (std::size_t k = 0; k <= D; ++k) {
                    shared = shared || (facet_of<D>(there, k) == facet &&
                                        filling.across[static_cast<std::size_t>(across)][k] == c);
                }
                CHECK(shared);
            }
        }
        for (const auto& [slot, count] : found) {
            CHECK(count == 1);
        }
        const auto used = std::count_if(filling.cell_at.begin(), filling.cell_at.end(),
                                        [](std::uint8_t cell) { return cell != Template::no_cell; });
        CHECK(static_cast<std::size_t>(used) == found.size());
    });
}

TEST_CASE(
    "two prisms that meet in a quadrilateral find each other's pieces of it, whichever way they number it",
    "[split]") {
    // Column i of the second prism is column[i] of the first, so that lateral faces map to each other.
    each_template<3>([](Split split, const Quads<3>& quads, const PrismTemplate<3>& filling) {
        for (const Symmetry<3>& symmetry : all_symmetries<3>()) {
            const auto& image = template_for<3>(split, symmetry(quads));
            for (std::size_t face = 0; face < 3 && !symmetry.backwards; ++face) {
                const auto [j, k] = quad_corners<3>(face);
                const bool turned = symmetry.column[j] > symmetry.column[k];
                for (std::size_t piece = 0; piece < 4; ++piece) {
                    const std::size_t there = turned && piece >= 2 ? 5 - piece : piece;
                    const auto facet = facet_in_slot(filling, PrismTemplate<3>::lateral(face, piece));
                    const auto other =
                        facet_in_slot(image, PrismTemplate<3>::lateral(symmetry.column[face], there));
                    REQUIRE(facet.has_value() == other.has_value());
                    if (facet) {
                        CHECK(sorted<3>({symmetry((*facet)[0]), symmetry((*facet)[1]),
                                         symmetry((*facet)[2])}) == *other);
                    }
                }
            }
        }
    });
}

TEST_CASE("the diagonal of a quadrilateral joins the corners that it says", "[split]") {
    const auto has_diagonal = [](Quad quad, std::uint8_t a, std::uint8_t b) {
        return facet_counts<2>(template_for<2>(Split::diagonal, {quad}).cells)[{a, b}] == 2;
    };
    CHECK(has_diagonal(Quad::rising, 0, 3));
    CHECK(has_diagonal(Quad::falling, 1, 2));
}

TEST_CASE("a cone from the prism's centre fills the prism, whatever its quadrilaterals carry", "[split]") {
    for (const Quads<3>& quads : all_quads<3>()) {
        CHECK(faults_of_filling<3>(cone_template<3>(PrismPoint<3>::centre, quads).cells, quads).empty());
    }
}

TEST_CASE("an unknown split is refused with the known ones named", "[split]") {
    CHECK(split_from_name("E", 3) == Split::E);
    CHECK(split_name(Split::B) == "B");
    CHECK_THROWS_WITH(split_from_name("E", 2),
                      Catch::Contains("\"centre\"") && Catch::Contains("\"diagonal\""));
    CHECK_THROWS_WITH(split_from_name("F", 3), Catch::Contains("\"A\", \"B\", \"C\", \"D\", \"E\""));
    CHECK_THROWS_AS(split_from_name("c", 3), UsageError);
}
