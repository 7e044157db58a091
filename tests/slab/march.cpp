// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/march.h"

#include "core/rounds.h"
#include "slab/march/cap_reuse.h"
#include "slab/swept_grid.h"
#include "slabhull/cases/settings.h"

#include "slabhull/cases/initial.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/tangling.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

using namespace slabhull;

namespace {

/// A coarse turning ellipsoid, or an expanding circle.
template<int D>
Case coarse_case() {
    return D == 2 ? experiment_at("expanding-circle", 0.8) : experiment_at("ellipsoid", 0.3);
}

template<int D>
March<D> coarse_march() {
    const Case the_case = coarse_case<D>();
    StageClock clock;
    IdCounter ids;
    MarchState<D> state = march_from<D>(initial_cap<D>(the_case, ids, {}, clock), the_case.start, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    return {std::move(state), std::move(settings)};
}

/// The motion of the first moving patch, twice as fast.
template<int D>
void correct(March<D>& march) {
    MovingPatch<D>& body = march.settings().motions.begin()->second;
    if constexpr (D == 2) {
        body.motion = expansion<D>({}, 0.5, 0);
    } else {
        body.motion = rotation<D>({0, 0, 1}, {}, 1);
    }
}

template<int D>
bool same_mesh(const SpatialMesh<D>& a, const SpatialMesh<D>& b) {
    return a.points == b.points && a.cells == b.cells && a.neighbors == b.neighbors &&
           a.boundary_facets == b.boundary_facets && a.vertex_ids == b.vertex_ids &&
           a.track_ids == b.track_ids;
}

constexpr Index quarter_divisions = 8;

/// A quarter disk about its tip, its arc and its two edges being patches.
MarchState<2> quarter_disk() {
    MarchState<2> state;
    constexpr Index n = quarter_divisions;
    state.cap.points.push_back({0, 0});
    for (Index k = 0; k <= n; ++k) {
        const double angle = 1.5707963267948966 * k / n;
        state.cap.points.push_back({std::cos(angle), std::sin(angle)});
    }
    for (Index k = 1; k <= n; ++k) {
        state.cap.cells.push_back({0, k, k + 1});
        state.cap.neighbors.push_back({no_index, k < n ? k : no_index, k > 1 ? k - 2 : no_index});
        state.cap.boundary_facets.push_back({k + 1, k});
        state.cap.boundary_patch.push_back(1);
    }
    state.cap.boundary_facets.push_back({1, 0});
    state.cap.boundary_facets.push_back({0, n + 1});
    state.cap.boundary_patch.insert(state.cap.boundary_patch.end(), {2, 3});
    state.cap.patches = {{1, "arc"}, {2, "below"}, {3, "left"}};
    for (std::size_t v = 0; v < state.cap.points.size(); ++v) {
        state.cap.vertex_ids.push_back(static_cast<PersistentId>(v));
        state.cap.track_ids.push_back(static_cast<TrackId>(v));
    }
    return march_from<2>(state.cap, 0, IdCounter{100});
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a proposal leaves the march as it was, and the same proposal is the same slab",
                       "[march]", ((int D), D), 2, 3) {
    const March<D> march = coarse_march<D>();
    const SpatialMesh<D> before = march.state().cap;
    const Slab<D> first = march.propose({0, 0.125, 0.25});
    const Slab<D> again = march.propose({0, 0.125, 0.25});
    CHECK(same_mesh(before, march.state().cap));
    CHECK(march.state().time == 0);
    CHECK(march.state().slab == 0);
    CHECK(first.hull.points == again.hull.points);
    CHECK(first.hull.cells == again.hull.cells);
    CHECK(first.hull.vertex_ids == again.hull.vertex_ids);
}

TEMPLATE_TEST_CASE_SIG("a corrected motion gives the same ids to the same vertices", "[march]", ((int D), D),
                       2, 3) {
    March<D> march = coarse_march<D>();
    const Slab<D> predicted = march.propose({0, 0.125, 0.25});
    correct(march);
    const Slab<D> corrected = march.propose({0, 0.125, 0.25});
    const std::size_t side_end = predicted.hull.points.size() - predicted.terminating().points.size();
    REQUIRE(side_end == corrected.hull.points.size() - corrected.terminating().points.size());
    const std::size_t boundary = march.state().boundary.vertex_count();
    const std::size_t kept = side_end + boundary;
    CHECK(std::equal(predicted.hull.vertex_ids.begin(),
                     predicted.hull.vertex_ids.begin() + static_cast<std::ptrdiff_t>(kept),
                     corrected.hull.vertex_ids.begin()));
    CHECK(std::equal(predicted.hull.track_ids.begin(),
                     predicted.hull.track_ids.begin() + static_cast<std::ptrdiff_t>(kept),
                     corrected.hull.track_ids.begin()));
    CHECK(predicted.hull.points != corrected.hull.points);
    CHECK(check_hull<D>(corrected.hull).clean());
}

TEMPLATE_TEST_CASE_SIG(
    "an accepted slab's terminating cap is the next initial cap, and ids are never used twice", "[march]",
    ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    std::set<PersistentId> used{march.state().cap.vertex_ids.begin(), march.state().cap.vertex_ids.end()};
    for (int k = 0; k < 4; ++k) {
        const double begin = march.state().time;
        march.propose({begin, begin + 0.05}); // refused: its ids are given again
        Slab<D> slab = march.propose({begin, begin + 0.05, begin + 0.1});
        const std::size_t initial = march.state().cap.points.size();
        for (std::size_t v = initial; v < slab.hull.points.size(); ++v) {
            REQUIRE(used.insert(slab.hull.vertex_ids[v]).second);
        }
        const SpatialMesh<D> next = slab.terminating();
        march.accept(std::move(slab));
        CHECK(same_mesh(next, march.state().cap));
        CHECK(march.state().slab == k + 1);
        CHECK(march.state().time == begin + 0.1);
    }
}

TEMPLATE_TEST_CASE_SIG("a slab that takes the initial cap over is the slab proposed, and must be accepted",
                       "[march]", ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    const SpatialMesh<D> before = march.state().cap;
    StageClock clock;
    const Slab<D> proposed = march.propose({0, 0.1});
    CHECK_THROWS_AS(march.build({0.5, 0.6}, clock), UsageError); // from another time: nothing is taken
    for (const std::vector<double>& times :
         {std::vector<double>{0, 0.15, 0.1}, {0, 0.1, 0.1}, {0, 0, 0.1}, {0, std::nan(""), 0.1}}) {
        CHECK_THROWS_AS(march.propose(times), UsageError);
        CHECK_THROWS_AS(march.build(times, clock), UsageError);
    }
    CHECK(same_mesh(before, march.state().cap));
    Slab<D> slab = march.build({0, 0.1}, clock);
    CHECK(slab.hull.points == proposed.hull.points);
    CHECK(slab.hull.cells == proposed.hull.cells);
    CHECK(slab.hull.neighbors == proposed.hull.neighbors);
    CHECK(slab.hull.vertex_ids == proposed.hull.vertex_ids);
    CHECK(slab.hull.track_ids == proposed.hull.track_ids);
    CHECK(march.state().cap.cells.empty());
    CHECK_THROWS_AS(march.build({0, 0.1}, clock), UsageError);
    CHECK_THROWS_AS(march.propose({0, 0.1}), UsageError);
    march.accept(std::move(slab));
    CHECK(same_mesh(proposed.terminating(), march.state().cap));
    CHECK(march.propose({0.1, 0.2}).hull.time[1] == 0.2);
}

TEMPLATE_TEST_CASE_SIG("a moved cap keeps its cells, and is meshed anew when its angles become too small",
                       "[march]", ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    march.settings().reuse = CapReuse::move;
    march.settings().reuse_angle = 1;
    const SpatialMesh<D> before = march.state().cap;
    Slab<D> near = march.propose({0, 0.02});
    CHECK(near.cap_moved);
    CHECK(near.moved_angle.value() > 1);
    CHECK(near.terminating().cells.size() == before.cells.size());
    CHECK(near.terminating().points.size() == before.points.size());
    CHECK(near.terminating().vertex_ids != before.vertex_ids);
    CHECK(check_hull<D>(near.hull).clean());
    CHECK(same_mesh(near.terminating(), march.propose({0, 0.02}).terminating()));
    march.accept(std::move(near));

    march.settings().reuse_angle = 59.9; // more than any mesh has
    const Slab<D> anew = march.propose({0.02, 0.04});
    CHECK_FALSE(anew.cap_moved);
    CHECK(anew.moved_angle.value() < 59.9);
    CHECK(check_hull<D>(anew.hull).clean());
    march.settings().reuse = CapReuse::none;
    SpatialMesh<D> without_move = march.propose({0.02, 0.04}).terminating();
    const SpatialMesh<D> with_move = anew.terminating();
    CHECK(without_move.track_ids != with_move.track_ids); // inside, where tracks begin
    without_move.track_ids = with_move.track_ids;
    CHECK(same_mesh(with_move, without_move));
}

TEST_CASE("a cap whose inner vertices come before its boundary's is moved, too", "[march]") {
    March<2> sorted = coarse_march<2>();
    SpatialMesh<2> cap = sorted.state().cap; // all vertices in the opposite order
    const auto last = static_cast<Index>(cap.points.size() - 1);
    const auto turn = [last](auto& cells) {
        for (auto& cell : cells) {
            for (Index& v : cell) {
                v = last - v;
            }
        }
    };
    turn(cap.cells);
    turn(cap.boundary_facets);
    std::reverse(cap.points.begin(), cap.points.end());
    std::reverse(cap.vertex_ids.begin(), cap.vertex_ids.end());
    std::reverse(cap.track_ids.begin(), cap.track_ids.end());
    SlabSettings<2> settings = sorted.settings();
    settings.reuse = CapReuse::move;
    const March<2> march{march_from<2>(cap, 0, sorted.state().ids), settings};
    const Slab<2> slab = march.propose({0, 0.1});
    CHECK(slab.cap_moved);
    CHECK(check_hull<2>(slab.hull).clean());
}

TEST_CASE("a slab that was not proposed from here is not accepted", "[march]") {
    March<2> march = coarse_march<2>();
    Slab<2> first = march.propose({0, 0.1});
    Slab<2> other = march.propose({0, 0.2});
    march.accept(std::move(first));
    CHECK_THROWS_AS(march.accept(std::move(other)), UsageError);
    CHECK_THROWS_AS(march.propose({0, 0.1}), UsageError);
    CHECK_THROWS_AS(march.propose({0.1, 0.1}), UsageError);
    CHECK(march.state().time == 0.1);
}

TEST_CASE("a boundary that tangles between levels is bracketed to a thousandth of the slab", "[tangling]") {
    March<2> march = coarse_march<2>();
    auto& body = march.settings().motions.begin()->second;
    body.surface = nullptr;
    const double speed = GENERATE(7.0, 10.0, 31.0);
    body.motion = translation<2>({speed, 0}); // from the wall at x = 5 the unit circle is 4 away
    try {
        march.propose({0, 0.25, 0.5, 0.75, 1});
        FAIL("not found");
    } catch (const TangledBoundary& tangled) {
        CHECK(tangled.good_until < 4 / speed + 1e-12);
        CHECK(tangled.tangled_at > 4 / speed - 1e-12);
        CHECK(tangled.tangled_at - tangled.good_until <= 1e-3);
        REQUIRE(tangled.entities.size() >= 2);
        CHECK_NOTHROW(march.propose({0, tangled.good_until}));
    }
}

TEST_CASE("ranks that check levels together find the tangling that one process finds", "[tangling]") {
    March<2> march = coarse_march<2>();
    const double speed = GENERATE(31.0, 10.0, 4.3); // in the first layer of eight, the fourth, the last
    const PatchMotions<2> motions{{march.settings().motions.begin()->first, {translation<2>({speed, 0})}}};
    const auto found_by = [&](Communicator* ranks) {
        const Sweep<2> sweep = sweep_measured<2>(march.state().boundary, march.state().cap, motions, 0,
                                                 even_levels(0, 1, 8), {}, {}, ranks)
                                   .sweep;
        try {
            require_embedded_levels<2>(sweep, motions, 0, {}, ranks);
        } catch (const TangledBoundary& tangled) {
            std::vector<std::int64_t> facets;
            for (const Entity& facet : tangled.entities) {
                facets.push_back(facet.number);
            }
            return std::tuple{std::string{tangled.what()}, tangled.good_until, tangled.tangled_at, facets};
        }
        return std::tuple{std::string{"nothing"}, 0.0, 0.0, std::vector<std::int64_t>{}};
    };
    const auto alone = found_by(nullptr);
    CHECK(std::get<0>(alone) != "nothing");
    for (const int size : {1, 2, 3, 12}) {
        std::vector<decltype(found_by(nullptr))> found(static_cast<std::size_t>(size));
        run_team(size, [&](Communicator& ranks) {
            found[static_cast<std::size_t>(ranks.rank())] = found_by(&ranks);
        });
        for (const auto& of_rank : found) {
            CHECK(of_rank == alone);
        }
    }
}

namespace {

/// A rank's share of a march whose caps are whole.
template<int D>
March<D> in_ranks(MarchState<D> state, SlabSettings<D> settings, Communicator& ranks) {
    leave_cells_on_first(state.cap, ranks);
    CapCells<D> cells = take_cells(state.cap, ranks);
    const HullRange here = range_of_rank(cells.all, ranks);
    state.cells = redistributed(std::move(cells), here, ranks);
    settings.ranks = &ranks;
    return {std::move(state), std::move(settings)};
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a cap that one step does not serve is moved from level to level in ranks, too",
                       "[march]", ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    SlabSettings<D>& settings = march.settings();
    Point<D> axis{};
    axis[D - 1] = 1;
    settings.motions.begin()->second = {rotation<D>(axis, {}, D == 2 ? 2 : 1)};
    settings.reuse = CapReuse::move;
    settings.reuse_angle = 1;
    const std::vector<double> times = even_levels(0, 1, 9);
    const MarchState<D>& start = march.state();
    const Sweep<D> sweep =
        sweep_boundary<D>(start.boundary, start.cap, settings.motions, 0, times, settings.trajectory);
    REQUIRE_FALSE(reuse_in_one_step<D>(start.cap, sweep, settings.reuse_angle).good());
    REQUIRE(reuse_by_levels<D>(start.cap, sweep, settings.reuse_angle).good());
    const Slab<D> whole = march.propose(times);
    for (const int size : {1, 2, 3, 7}) {
        std::vector<Slab<D>> made(static_cast<std::size_t>(size));
        run_team(size, [&](Communicator& ranks) {
            StageClock clock;
            March<D> share = in_ranks<D>(start, settings, ranks);
            made[static_cast<std::size_t>(ranks.rank())] = share.build(times, clock);
        });
        for (const Slab<D>& slab : made) {
            CHECK(slab.cap_moved);
            CHECK(slab.moved_angle == whole.moved_angle);
            CHECK(specimens::part_is_of<D>(*slab.part, whole.hull));
        }
    }
}

TEST_CASE("a vertex that projection would move past its neighbours is refused", "[tangling]") {
    March<2> march = coarse_march<2>();
    auto& body = march.settings().motions.begin()->second;
    body.surface = sphere_surface<2>({0, 0}, 1.3);
    CHECK_THROWS_WITH(march.propose({0, 0.5}), Catch::Contains("shortest edge") &&
                                                   Catch::Contains("t = 0.5") && Catch::Contains("body") &&
                                                   !Catch::Contains("move 0 vertices"));
}

TEST_CASE("vertices where projected patches meet stay on all of their surfaces", "[march]") {
    SlabSettings<2> settings;
    settings.trajectory = {Scheme::euler, 8, 1e-10}; // far off, so that projection has something to do
    const auto turning = rotation<2>({}, {}, 1);
    settings.motions[1] = {turning, sphere_surface<2>({0, 0}, 1)};
    settings.motions[2] = {turning, plane_surface<2>({0, 0}, {0, 1})};
    settings.motions[3] = {turning, plane_surface<2>({0, 0}, {1, 0})};
    const March<2> march{quarter_disk(), settings};
    const Slab<2> slab = march.propose({0, 0.5});
    const Array<Point<2>> end = slab.terminating().points;
    CHECK(std::hypot(end[0][0], end[0][1]) < 1e-12);
    for (const Index corner : {Index{1}, quarter_divisions + 1}) {
        const double angle = 0.5 + (corner == 1 ? 0 : 1.5707963267948966);
        const auto& at = end[corner];
        CHECK(std::hypot(at[0] - std::cos(angle), at[1] - std::sin(angle)) < 1e-12);
    }
    CHECK(slab.projected.at(1).largest > 1e-3);
}

TEST_CASE("over a thousand slabs no id is given twice, and each initial cap is the cap before", "[march]") {
    SlabSettings<2> settings;
    const auto turning = rotation<2>({}, {}, 1);
    for (const PatchNumber patch : {1, 2, 3}) {
        settings.motions[patch].motion = turning;
    }
    March<2> march{quarter_disk(), settings};
    PersistentId highest = march.state().ids.next - 1;
    const int slabs = rounds(1000);
    for (int k = 0; k < slabs; ++k) {
        const double begin = march.state().time;
        Slab<2> slab = march.propose({begin, begin + 0.01});
        const SpatialMesh<2>& cap = march.state().cap;
        std::vector<PersistentId> fresh{slab.hull.vertex_ids.begin() +
                                            static_cast<std::ptrdiff_t>(cap.points.size()),
                                        slab.hull.vertex_ids.end()};
        std::sort(fresh.begin(), fresh.end());
        const bool kept =
            std::equal(cap.vertex_ids.begin(), cap.vertex_ids.end(), slab.hull.vertex_ids.begin());
        const bool unique = std::adjacent_find(fresh.begin(), fresh.end()) == fresh.end();
        const bool placed =
            std::equal(cap.points.begin(), cap.points.end(), slab.hull.points.begin(),
                       [](const auto& x, const auto& p) { return x[0] == p[0] && x[1] == p[1]; });
        if (!kept || !unique || !placed || fresh.front() <= highest) {
            FAIL("in slab " << k);
        }
        highest = fresh.back();
        march.accept(std::move(slab));
    }
    CHECK(march.state().slab == slabs);
}

TEMPLATE_TEST_CASE_SIG("a march that is stopped in any stage is as before", "", ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    const std::vector<double> times{0, 0.5, 1};
    const Slab<D> expected = march.propose(times);
    for (const std::string last : {"trajectories", "boundary check", "cap meshing", "stitching"}) {
        std::vector<std::string> stages;
        march.on_progress([&](const WorkState& state) {
            if (stages.empty() || stages.back() != state.stage) {
                stages.push_back(state.stage);
            }
            return state.stage != last;
        });
        StageClock clock;
        CHECK_THROWS_AS(march.build(times, clock), Interrupted);
        CHECK(stages.back() == last);
    }
    march.on_progress({});
    const Slab<D> again = march.propose(times);
    CHECK(again.hull.points == expected.hull.points);
    CHECK(again.hull.cells == expected.hull.cells);
}

TEMPLATE_TEST_CASE_SIG("slabs of a march that moves its caps are filled, one after the other",
                       "[march][fill]", ((int D), D), 2, 3) {
    March<D> march = coarse_march<D>();
    march.settings().reuse = CapReuse::move;
    march.settings().reuse_angle = 1;
    std::map<PersistentId, Point<D + 1>> terminating;
    for (int k = 0; k < 3; ++k) {
        const double begin = march.state().time;
        Slab<D> slab = march.propose({begin, begin + 0.02, begin + 0.04});
        REQUIRE(slab.cap_moved);
        REQUIRE(check_hull<D>(columns_of(slab.hull)).clean());
        const Filling<D> filling = fill_slab(slab.hull);
        const FillingReport report = check_filling<D>(columns_of(filling), &slab.hull);
        INFO(findings_as_text(report));
        CHECK(report.clean());
        for (std::size_t f = 0; f < slab.hull.initial_cells && k > 0; ++f) {
            for (const Index v : filling.facets[f]) { // what the slab before ended with
                REQUIRE(terminating.at(filling.vertex_ids[v]) == filling.points[v]);
            }
        }
        terminating.clear();
        for (std::size_t v = slab.hull.terminating_points_begin(); v < filling.hull_points; ++v) {
            terminating[filling.vertex_ids[v]] = filling.points[v];
        }
        march.accept(std::move(slab));
    }
}

TEST_CASE("a slab whose cap was meshed anew is not filled, and is told so", "[march][fill]") {
    March<2> march = coarse_march<2>();
    march.settings().reuse = GENERATE(CapReuse::none, CapReuse::move);
    march.settings().reuse_angle = 59.9; // more than any mesh has
    const Slab<2> slab = march.propose({0, 0.1});
    REQUIRE_FALSE(slab.cap_moved);
    try {
        fill_slab(slab.hull);
        FAIL("filled");
    } catch (const GeometryError& error) {
        CHECK_THAT(error.what(), Catch::Contains("meshed anew"));
        CHECK_FALSE(error.entities.empty());
    }
}
