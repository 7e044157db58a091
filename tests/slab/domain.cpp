// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/domain.h"
#include "slab/specimens.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/march.h"
#include "slabhull/topology/adjacency.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

using namespace slabhull;

namespace {

/// The box around a body, with the body's facets as patch 5 and the user's numbers from 1000, 2000 and 3000.
template<int D>
DomainInput<D> box_around_body() {
    const auto grid = specimens::box_with_body<D>();
    DomainInput<D> input;
    input.points.assign(grid.points.begin(), grid.points.end());
    input.cells.assign(grid.cells.begin(), grid.cells.end());
    const auto adjacency = build_adjacency<D>(input.cells, input.points.size());
    const auto outside = [&](Index v) {
        return std::any_of(input.points[v].begin(), input.points[v].end(),
                           [](double x) { return x == 0 || x == 5; });
    };
    for (std::size_t c = 0; c < input.cells.size(); ++c) {
        for (int i = 0; i <= D; ++i) {
            const auto facet = outward_facet<D>(input.cells[c], i);
            if (adjacency.neighbors[c][static_cast<std::size_t>(i)] == no_index &&
                std::none_of(facet.begin(), facet.end(), outside)) {
                input.facets.push_back(facet);
                input.facet_patch.push_back(5);
            }
        }
    }
    input.patches = {{5, "body"}, {9, "nowhere"}};
    input.where = "solver";
    for (std::size_t i = 0; i < input.cells.size(); ++i) {
        input.cell_numbers.push_back(static_cast<std::int64_t>(1000 + i));
    }
    for (std::size_t i = 0; i < input.facets.size(); ++i) {
        input.facet_numbers.push_back(static_cast<std::int64_t>(2000 + i));
    }
    for (std::size_t i = 0; i < input.points.size(); ++i) {
        input.point_numbers.push_back(static_cast<std::int64_t>(3000 + i));
    }
    return input;
}

/// Refused, with exactly these entities, and words in the message.
template<int D>
void require_refused(DomainInput<D> input, const std::string& words, const std::string& kind,
                     const std::set<std::int64_t>& numbers) {
    try {
        make_domain<D>(std::move(input));
        FAIL("accepted, though: " << words);
    } catch (const InputError& error) {
        INFO(error.what());
        CHECK(std::string{error.what()}.starts_with("solver: "));
        CHECK(std::string{error.what()}.find(words) != std::string::npos);
        std::set<std::int64_t> named;
        for (const Entity& entity : error.entities) {
            CHECK(entity.kind == kind);
            named.insert(entity.number);
        }
        CHECK(named == numbers);
    }
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a mesh in arrays is a domain that a march starts from", "", ((int D), D), 2, 3) {
    DomainInput<D> input = box_around_body<D>();
    const std::size_t points = input.points.size();
    const std::size_t body_facets = input.facets.size();
    REQUIRE(body_facets > 0);
    Domain<D> domain = make_domain<D>(input, IdCounter{77});
    CHECK(domain.mesh.points == input.points);
    CHECK(domain.mesh.cells == input.cells);
    CHECK(domain.mesh.patches == PatchList{{5, "body"}, {6, "boundary"}});
    CHECK(domain.facets_without_patch == domain.mesh.boundary_facets.size() - body_facets);
    CHECK(domain.inner_facets.empty());
    CHECK(std::is_sorted(domain.mesh.boundary_patch.begin(), domain.mesh.boundary_patch.end()));
    CHECK(domain.mesh.vertex_ids.front() == 77);
    CHECK(domain.mesh.vertex_ids.back() == static_cast<PersistentId>(76 + points));
    CHECK(domain.ids.take(1) == static_cast<PersistentId>(77 + points));

    SlabSettings<D> settings;
    Point<D> velocity{};
    velocity[0] = 0.25;
    settings.motions[5].motion = translation<D>(velocity);
    March<D> march{march_from<D>(make_domain<D>(input), 2.0), settings};
    Slab<D> slab = march.propose({2.0, 2.5, 3.0});
    const HullReport report = check_hull(slab.hull);
    CHECK(findings_as_text(report) == findings_as_text({}));
    CHECK(report.clean());
    CHECK(report.cells_by_patch.size() == 2);
    march.accept(std::move(slab));
    CHECK(march.state().slab == 1);
}

TEMPLATE_TEST_CASE_SIG("groups may each be oriented their own way", "", ((int D), D), 2, 3) {
    DomainInput<D> input = box_around_body<D>();
    const Array<Simplex<D>> positive = input.cells;
    input.cell_group.assign(input.cells.size(), 1);
    for (std::size_t c = 0; c < input.cells.size(); c += 2) {
        std::swap(input.cells[c][0], input.cells[c][1]);
        input.cell_group[c] = 2;
    }
    CHECK(make_domain<D>(input).mesh.cells == positive);
    input.cell_group.clear();
    CHECK_THROWS_AS(make_domain<D>(input), InputError);
}

TEMPLATE_TEST_CASE_SIG("facets inside the domain are counted", "", ((int D), D), 2, 3) {
    DomainInput<D> input = box_around_body<D>();
    const auto adjacency = build_adjacency<D>(input.cells, input.points.size());
    std::size_t cell = 0;
    std::size_t i = 0;
    while (adjacency.neighbors[cell][i] == no_index) {
        i = (i + 1) % (D + 1);
        cell += i == 0;
    }
    const std::size_t inner = input.facets.size();
    input.facets.push_back(outward_facet<D>(input.cells[cell], static_cast<int>(i)));
    input.facet_patch.push_back(9);
    input.facet_numbers.push_back(12);
    const Domain<D> domain = make_domain<D>(input);
    CHECK(domain.inner_facets == std::vector<std::size_t>{inner});
    CHECK(domain.mesh.patches == PatchList{{5, "body"}, {6, "boundary"}});
}

TEMPLATE_TEST_CASE_SIG("what is wrong in the arrays is named by the user's numbers", "", ((int D), D), 2, 3) {
    const DomainInput<D> sound = box_around_body<D>();
    DomainInput<D> input = sound;
    SECTION("a cell that refers to no point") {
        input.cells[3][1] = static_cast<Index>(input.points.size());
        require_refused(input, "do not exist", "cell", {1003});
    }
    SECTION("a facet that refers to no point") {
        input.facets[1][0] = no_index;
        require_refused(input, "do not exist", "facet", {2001});
    }
    SECTION("a point that no cell uses") {
        input.points.push_back(input.points[0]);
        input.point_numbers.push_back(4);
        require_refused(input, "belong to no cell", "vertex", {4});
    }
    SECTION("a coordinate that is not finite") {
        input.points[2][1] = std::numeric_limits<double>::quiet_NaN();
        require_refused(input, "not finite", "vertex", {3002});
    }
    SECTION("a degenerate cell") {
        input.cells[4][0] = input.cells[4][1];
        require_refused(input, "degenerate", "cell", {1004});
    }
    SECTION("an inverted cell") {
        std::swap(input.cells[5][0], input.cells[5][1]);
        require_refused(input, "inverted", "cell", {1005});
    }
    SECTION("a cell twice") {
        input.cells.push_back(input.cells[0]);
        input.cell_numbers.push_back(99);
        CHECK_THROWS_AS(make_domain<D>(input), InputError);
    }
    SECTION("a facet of no cell") {
        const std::size_t f = input.facets.size();
        Facet<D> stray = input.cells[0].size() > 0 ? outward_facet<D>(input.cells[0], 0) : Facet<D>{};
        stray[0] = input.cells.back()[0];
        stray[1] = input.cells[0][1];
        input.facets.push_back(stray);
        input.facet_patch.push_back(5);
        input.facet_numbers.push_back(static_cast<std::int64_t>(2000 + f));
        DomainInput<D> of_more = input;
        of_more.facets_of_more = true;
        CHECK(make_domain<D>(of_more).mesh.boundary_patch == make_domain<D>(sound).mesh.boundary_patch);
        require_refused(input, "not facets of any cell", "facet", {static_cast<std::int64_t>(2000 + f)});
    }
    SECTION("a negative patch") {
        input.facet_patch[0] = -1;
        require_refused(input, "negative patch", "facet", {2000});
    }
    SECTION("no cells") {
        DomainInput<D> empty;
        CHECK_THROWS_AS(make_domain<D>(empty), InputError);
    }
    SECTION("arrays that do not go together") {
        input.facet_patch.pop_back();
        CHECK_THROWS_AS(make_domain<D>(input), UsageError);
    }
    SECTION("two parts that share a vertex") {
        DomainInput<D> parts;
        parts.where = "solver";
        const auto corner = [](std::size_t k, double sign) {
            Point<D> point{};
            point[k] = sign;
            return point;
        };
        parts.points.push_back({});
        Simplex<D> first{};
        Simplex<D> second{};
        for (std::size_t k = 0; k < D; ++k) {
            first[k + 1] = static_cast<Index>(parts.points.size());
            parts.points.push_back(corner(k, 1));
            second[k + 1] = static_cast<Index>(parts.points.size());
            parts.points.push_back(corner(k, -1));
        }
        if (D == 3) {
            std::swap(second[1], second[2]);
        }
        parts.cells = {first, second};
        CHECK_THROWS_AS(make_domain<D>(parts), InputError);
    }
}

TEMPLATE_TEST_CASE_SIG("of a facet that is listed twice the first counts, and both are told", "",
                       ((int D), D), 2, 3) {
    DomainInput<D> input = box_around_body<D>();
    const std::size_t again = input.facets.size();
    input.facets.push_back(input.facets[2]);
    std::swap(input.facets.back()[0], input.facets.back()[1]);
    input.facet_patch.push_back(9);
    input.facet_numbers.push_back(7);
    const Domain<D> domain = make_domain<D>(input);
    CHECK(domain.repeated_facets == std::vector<std::array<std::size_t, 2>>{{2, again}});
    CHECK(domain.mesh.patches == PatchList{{5, "body"}, {6, "boundary"}});
    CHECK(domain.inner_facets.empty());
}
