// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slab.h"
#include "slabhull/cases/settings.h"

#include "slabhull/cases/initial.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/check.h"
#include "slabhull/topology/homology.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <set>

using namespace slabhull;

namespace {

/// A march of a case in memory: its hulls and caps.
template<int D>
struct March {
    std::vector<SpatialMesh<D>> caps;
    std::vector<Hull<D>> hulls;
    IdCounter ids;
};

template<int D>
March<D> march(const Case& the_case, const std::vector<double>& slab_times) {
    March<D> result;
    StageClock clock;
    result.caps.push_back(initial_cap<D>(the_case, result.ids, {}, clock));
    const auto settings = settings_of<D>(the_case, boundary_of(result.caps[0]));
    for (std::size_t i = 0; i + 1 < slab_times.size(); ++i) {
        const double middle = (slab_times[i] + slab_times[i + 1]) / 2;
        Slab<D> slab = build_slab<D>(result.caps.back(), boundary_of(result.caps.back()), static_cast<int>(i),
                                     {slab_times[i], middle, slab_times[i + 1]}, settings, result.ids, clock);
        result.ids = slab.next_ids;
        result.caps.push_back(slab.terminating());
        result.hulls.push_back(std::move(slab.hull));
    }
    return result;
}

/// A coarse one of the experiments.
Case coarse(const std::string& name) {
    return experiment_at(name, name.find("circle") != std::string::npos ? 0.8 : 0.3);
}

template<int D>
std::array<Point<D>, 2> bounds(const SpatialMesh<D>& cap) {
    std::array<Point<D>, 2> box{cap.points[0], cap.points[0]};
    for (const auto& x : cap.points) {
        for (std::size_t k = 0; k < D; ++k) {
            box[0][k] = std::min(box[0][k], x[k]);
            box[1][k] = std::max(box[1][k], x[k]);
        }
    }
    return box;
}

template<int D>
void check_march(const March<D>& m) {
    std::set<PersistentId> all_ids;
    for (std::size_t s = 0; s < m.hulls.size(); ++s) {
        const Hull<D>& hull = m.hulls[s];
        CheckOptions options;
        options.betti_cells = practical_betti_cells;
        const HullReport report = check_hull<D>(hull, options);
        for (const Finding& finding : report.findings) {
            FAIL_CHECK(finding.text);
        }
        const SpatialMesh<D>& cap = m.caps[s];
        for (std::size_t v = 0; v < cap.points.size();
             ++v) { // the initial cap is the cap before, bit for bit
            REQUIRE(std::equal(cap.points[v].begin(), cap.points[v].end(), hull.points[v].begin()));
            REQUIRE(hull.vertex_ids[v] == cap.vertex_ids[v]);
            REQUIRE(hull.track_ids[v] == cap.track_ids[v]);
        }
        const std::size_t inherited = s == 0 ? 0 : cap.points.size();
        for (std::size_t v = inherited; v < hull.points.size(); ++v) {
            REQUIRE(all_ids.insert(hull.vertex_ids[v]).second);
        }
    }
    CHECK(*all_ids.rbegin() < m.ids.next);
}

} // namespace

TEMPLATE_TEST_CASE_SIG("three slabs of every experiment are sound hulls with ids that are never reused",
                       "[slab]", ((int D), D), 2, 3) {
    const std::vector<std::string> names =
        D == 2 ? std::vector<std::string>{"circle", "expanding-circle"}
               : std::vector<std::string>{"sphere", "expanding-sphere", "ellipsoid", "tandem-ellipsoids"};
    for (const std::string& name : names) {
        INFO(name);
        check_march(march<D>(coarse(name), {0.0, 0.3, 0.6, 1.0}));
    }
}

TEST_CASE("every split of each dimension gives a sound hull", "[slab]") {
    Case solid = coarse("ellipsoid");
    for (const Split split : {Split::C, Split::E}) {
        solid.split = split;
        check_march(march<3>(solid, {0.0, 1.0}));
    }
    Case plane = coarse("expanding-circle");
    for (const Split split : {Split::centre, Split::diagonal}) {
        plane.split = split;
        check_march(march<2>(plane, {0.0, 1.0}));
    }
}

TEST_CASE("shifting a standing domain in time changes nothing but the times", "[slab]") {
    const auto early = march<2>(coarse("circle"), {0.0, 1.0});
    const auto late = march<2>(coarse("circle"), {8.0, 9.0});
    REQUIRE(early.hulls[0].cells == late.hulls[0].cells);
    for (std::size_t v = 0; v < early.hulls[0].points.size(); ++v) {
        const auto& a = early.hulls[0].points[v];
        const auto& b = late.hulls[0].points[v];
        REQUIRE(a[0] == b[0]);
        REQUIRE(a[1] == b[1]);
        REQUIRE(a[2] + 8.0 == b[2]);
    }
}

TEST_CASE("tracks follow boundary vertices: a turning body's stay on its surface, the walls' stand still",
          "[slab]") {
    const auto m = march<3>(coarse("ellipsoid"), {0.0, 1.0});
    const Hull<3>& hull = m.hulls[0];
    std::map<TrackId, std::vector<Point<4>>> tracks;
    for (std::size_t v = 0; v < hull.points.size(); ++v) {
        if (hull.track_ids[v] != no_track) {
            tracks[hull.track_ids[v]].push_back(hull.points[v]);
        }
    }
    for (const auto& [track, points] : tracks) {
        REQUIRE(points.size() == 3);
        for (const Point<4>& p : points) {
            const double angle = std::acos(-1.0) / 2 * p[3];
            const double x = std::cos(angle) * p[0] + std::sin(angle) * p[1];
            const double y = -std::sin(angle) * p[0] + std::cos(angle) * p[1];
            const bool on_wall = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) == 8;
            const double ellipsoid = x * x + y * y / 9 + p[2] * p[2] / 4;
            REQUIRE((on_wall || std::abs(ellipsoid - 1) < 1e-12));
        }
        const bool first_on_wall = std::abs(points[0][0]) == 8;
        if (first_on_wall) {
            REQUIRE(points[0][0] == points[2][0]);
        }
    }
}

TEST_CASE("a body that expands keeps its shape, and the box around it does not move", "[slab]") {
    const auto m = march<2>(coarse("expanding-circle"), {0.0, 1.0});
    CHECK(bounds(m.caps[0]) == bounds(m.caps[1]));
    double nearest = 1e300;
    for (const auto& facet : m.caps[1].boundary_facets) {
        nearest = std::min(nearest, std::hypot(m.caps[1].points[facet[0]][0], m.caps[1].points[facet[0]][1]));
    }
    CHECK(nearest == Approx(1.25).epsilon(1e-14));
}

TEST_CASE("a motion that drives the body through the wall is refused with the time and the patches",
          "[slab]") {
    Case the_case = coarse("circle");
    MotionSpec away;
    away.kind = MotionSpec::Kind::translation;
    away.velocity = {20, 0};
    the_case.motions["body"] = away;
    the_case.projections.clear();
    CHECK_THROWS_WITH(march<2>(the_case, {0.0, 0.5}),
                      Catch::Contains("t = 0.2001") && Catch::Contains("good until t = 0.1997") &&
                          Catch::Contains("body") && Catch::Contains("walls"));
}

TEST_CASE("a patch that the domain has not is refused with those that it has", "[slab]") {
    Case the_case = coarse("circle");
    the_case.motions["rotor"] = the_case.motions.empty() ? MotionSpec{} : the_case.motions.begin()->second;
    const Boundary<2> boundary{{{}, {}, {}, {{1, "body"}, {2, "walls"}}}};
    CHECK_THROWS_AS(settings_of<2>(the_case, boundary), UsageError);
    CHECK_THROWS_WITH(settings_of<2>(the_case, boundary),
                      Catch::Contains("rotor") && Catch::Contains("walls"));
}
