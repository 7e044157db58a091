// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/check_embedding.h"

#include "geometry/simplex_judge.h"
#include "slab/parts.h"
#include "slab/specimens.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/hull_embedding.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>

using namespace slabhull;
using Catch::Matchers::Contains;
using specimens::Claims;

namespace {

struct Verdict {
    HullReport report;
    std::optional<EmbeddingSummary> embedding;
};

template<int D>
Verdict checked(const Claims<D>& claims, const CheckOptions& options = {}) {
    Verdict verdict{check_hull<D>(claims.columns(), options), {}};
    verdict.embedding = check_embedding<D>(claims.columns(), options, verdict.report);
    return verdict;
}

/// Coordinates are multiples of 1/20 in these specimens; whole ones for the judge.
template<int D>
Claims<D> in_twentieths(Claims<D> claims) {
    for (Point<D + 1>& p : claims.points) {
        for (double& x : p) {
            x = std::round(20 * x);
        }
    }
    return claims;
}

template<int D>
HullEmbedding<D> examine(const Claims<D>& claims, std::size_t limit = 100000) {
    const auto adjacency = build_adjacency<D>(claims.cells, claims.points.size());
    const auto found = examine_embedding<D>(claims.points, claims.cells, adjacency, limit);
    tests::require_same_in_ranks<D>(claims.points, claims.cells, adjacency, limit, found);
    return found;
}

template<int D>
std::set<std::pair<Index, Index>> pairs_of(const HullEmbedding<D>& embedding) {
    std::set<std::pair<Index, Index>> pairs;
    for (const Crossing<D + 1>& crossing : embedding.crossings) {
        pairs.emplace(crossing.first, crossing.second);
    }
    return pairs;
}

/// Moves vertices chosen by `movable` by whole numbers up to `reach` in space.
template<int D, class Movable>
void shake(Claims<D>& claims, int reach, unsigned seed, const Movable& movable) {
    std::mt19937 random{seed};
    for (Point<D + 1>& p : claims.points) {
        for (std::size_t k = 0; k < D && movable(p); ++k) {
            p[k] += static_cast<int>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
        }
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("sound hulls do not cross themselves, and their caps need no pairs", "[embedding]",
                       ((int D), D), 2, 3) {
    for (const auto& grid :
         {specimens::full_box<D>(2), specimens::box_with_body<D>(), specimens::box_with_two_bodies<D>()}) {
        const Claims<D> claims{specimens::swept(grid, 2)};
        const auto [report, embedding] = checked(claims);
        CHECK(report.clean());
        CHECK(report.skipped.empty());
        REQUIRE(embedding);
        CHECK(embedding->crossings == 0);
        CHECK(embedding->caps_proven);
        CHECK(embedding->tested_cells == report.cells_by_region[1]);
        CHECK(embedding->proven_stars > embedding->stars * 9 / 10);
    }
}

TEMPLATE_TEST_CASE_SIG("a side that is shaken between its levels crosses just where a judge says",
                       "[embedding][long]", ((int D), D), 2, 3) {
    std::size_t planted = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        Claims<D> claims =
            in_twentieths(Claims<D>{specimens::swept(specimens::full_box<D>(D == 2 ? 3 : 1), 2)});
        shake(claims, static_cast<int>(4 + 4 * seed), seed, [](const Point<D + 1>& p) { return p[D] == 30; });
        const HullEmbedding<D> embedding = examine(claims);
        CHECK(embedding.caps_proven);
        const auto judged = tests::judged_crossings<D>(claims.points, claims.cells);
        CHECK(pairs_of(embedding) == judged);
        planted += judged.size();
    }
    CHECK(planted > 0);
}

TEMPLATE_TEST_CASE_SIG("caps that overlap themselves are paired cell by cell, as a judge does", "[embedding]",
                       ((int D), D), 2, 3) {
    Claims<D> claims = in_twentieths(Claims<D>{specimens::swept(specimens::full_box<D>(2), 1)});
    Point<D + 1> inner;
    inner.fill(20);
    Point<D + 1>& vertex = *std::find(claims.points.begin(), claims.points.end(), inner);
    vertex[0] += 3; // inside still
    CHECK(examine(claims).caps_proven);
    CHECK(examine(claims).crossings.empty());
    vertex[0] += 20; // outside
    const HullEmbedding<D> embedding = examine(claims);
    CHECK_FALSE(embedding.caps_proven);
    const auto judged = tests::judged_crossings<D>(claims.points, claims.cells);
    CHECK_FALSE(judged.empty());
    CHECK(pairs_of(embedding) == judged);
}

TEST_CASE("hulls whose caps overlap as a whole are found out", "[embedding]") {
    // Two boxes, each a sound hull, at the same place: their boundaries are closed and proper one by one.
    const Claims<3> one = in_twentieths(Claims<3>{specimens::swept(specimens::full_box<3>(1), 1)});
    for (const double shift : {0.0, 7.0, 20.0, 21.0}) { // the same, overlapping, in touch, apart
        Claims<3> both = one;
        const auto offset = static_cast<Index>(one.points.size());
        for (Point<4> p : one.points) {
            p[0] += shift;
            both.points.push_back(p);
        }
        for (Simplex<3> cell : one.cells) {
            for (Index& v : cell) {
                v += offset;
            }
            both.cells.push_back(cell);
        }
        const HullEmbedding<3> embedding = examine(both);
        CHECK(embedding.caps_proven == (shift == 21));
        CHECK(embedding.crossings.empty() == (shift == 21));
        CHECK(pairs_of(embedding) == tests::judged_crossings<3>(both.points, both.cells));
    }
}

TEMPLATE_TEST_CASE_SIG("bodies that meet between levels are findings with numbers, patches and time",
                       "[embedding]", ((int D), D), 2, 3) {
    Claims<D> claims{specimens::swept(specimens::box_with_two_bodies<D>(), 2)};
    for (Point<D + 1>& p : claims.points) { // the two exchange places on the middle level
        const bool of_body = std::all_of(p.begin(), p.begin() + D, [](double x) { return x > 0 && x < 5; });
        if (p[D] == 1.5 && of_body) {
            p[0] = p[0] < 2.5 ? p[0] + 1.7 : p[0] - 1.7;
        }
    }
    CheckOptions options;
    options.cell_number = [](Index c) { return 1000 + std::int64_t{c}; };
    options.most_findings = 5;
    auto [report, embedding] = checked(claims, options);
    REQUIRE(embedding);
    CHECK(embedding->caps_proven);
    CHECK(embedding->crossings == report.count(Defect::self_crossing));
    CHECK(report.total() == embedding->crossings); // nothing else is blamed
    REQUIRE(report.findings.size() == 5);
    for (const Finding& finding : report.findings) {
        CHECK(finding.what == Defect::self_crossing);
        REQUIRE(finding.entities.size() == 2);
        for (const Entity& entity : finding.entities) {
            CHECK(entity.kind == "cell");
            const auto c = static_cast<std::size_t>(entity.number - 1000);
            CHECK(claims.patch.at(c) == 2);
            CHECK_THAT(finding.text,
                       Contains("cell " + std::to_string(entity.number) + " (patch body, t = 1"));
        }
        CHECK_THAT(finding.text, Contains(" meet at t = 1."));
    }
    CHECK(nlohmann::json::parse(report_as_json(*embedding))["crossings"] == embedding->crossings);
    CHECK(nlohmann::json::parse(report_as_json(report))["defects"]["self-crossing"] == embedding->crossings);
}

TEMPLATE_TEST_CASE_SIG("ranks say of bodies that meet what one process says", "[embedding]", ((int D), D), 2,
                       3) {
    Hull<D> hull = specimens::swept(specimens::box_with_two_bodies<D>(), 2);
    const auto place = [](const Point<D + 1>& p) { // of a vertex of the left body on the middle level
        const bool of_body = std::all_of(p.begin(), p.begin() + D, [](double x) { return x > 0 && x < 5; });
        return p[D] == 1.5 && of_body && p[0] < 2.5 ? p[0] : 0;
    };
    Point<D + 1>& vertex =
        *std::max_element(hull.points.begin(), hull.points.end(),
                          [&](const auto& a, const auto& b) { return place(a) < place(b); });
    for (std::size_t k = 1; k < D; ++k) {
        vertex[k] += 0.31; // so that it comes to the inside of a facet
    }
    CheckOptions options;
    options.most_findings = 1000;
    HullReport whole;
    std::optional<EmbeddingSummary> alone;
    do { // until it is a little within the other
        vertex[0] += 0.02;
        whole = check_hull<D>(hull, options);
        alone = check_embedding<D>(columns_of(hull), options, whole);
    } while (alone->crossings == 0);
    REQUIRE(alone->all_listed);
    run_team(3, [&](Communicator& team) {
        const HullPart<D> part = tests::part_of<D>(
            hull.points, hull.cells, [&](std::size_t c, std::size_t i) { return hull.neighbors[c][i]; },
            range_of_part(hull.cells.size(), static_cast<std::size_t>(team.rank()), 3));
        HullReport report;
        const EmbeddingSummary summary = check_embedding_of_parts(part, hull, team, options, report);
        const bool same_texts = std::equal(
            report.findings.begin(), report.findings.end(), whole.findings.begin(), whole.findings.end(),
            [](const Finding& a, const Finding& b) { return a.text == b.text && a.what == b.what; });
        team.barrier();
        if (!same_texts || summary.crossings != alone->crossings) {
            throw std::runtime_error{"rank " + std::to_string(team.rank()) + " says something else"};
        }
    });
}

TEST_CASE("the findings are the same for any number of threads", "[embedding]") {
    Claims<3> claims = in_twentieths(Claims<3>{specimens::swept(specimens::box_with_body<3>(), 2)});
    shake(claims, 15, 3, [](const Point<4>& p) { return p[3] == 30; });
    const auto told = [&](int threads) {
        set_thread_count(threads);
        const HullEmbedding<3> embedding = examine(claims, 50);
        set_thread_count(0);
        return std::tuple{pairs_of(embedding), embedding.tested_pairs, embedding.exact_pairs,
                          embedding.all_listed};
    };
    CHECK(told(1) == told(4));
    CHECK_FALSE(std::get<3>(told(1)));
}

TEST_CASE("what geometry does not apply to is skipped with a reason", "[embedding]") {
    Claims<3> claims{specimens::swept(specimens::full_box<3>(1), 1)};
    claims.points[0][1] = std::numeric_limits<double>::quiet_NaN();
    const auto [report, embedding] = checked(claims);
    CHECK_FALSE(embedding);
    REQUIRE_FALSE(report.skipped.empty());
    CHECK_THAT(report.skipped.back(), Contains("embedding"));
}

TEST_CASE("a hull that is torn or inside out is still examined for crossings", "[embedding]") {
    Claims<2> claims{specimens::swept(specimens::box_with_body<2>(), 1)};
    claims.cells.pop_back();
    for (Simplex<2>& cell : claims.cells) {
        std::swap(cell[0], cell[1]);
    }
    const HullEmbedding<2> embedding = examine(claims);
    CHECK_FALSE(embedding.caps_proven); // a facet is open
    CHECK(embedding.tested_cells == claims.cells.size());
    CHECK(embedding.crossings.empty());
}
