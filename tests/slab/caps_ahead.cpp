// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/caps_ahead.h"

#include "slabhull/cases/experiments.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/slab/march.h"

#include <catch2/catch.hpp>

#include <memory>
#include <optional>

using namespace slabhull;

namespace {

/// A march of a coarse experiment, with several threads while it lives.
template<int D>
class Trial {
public:
    Trial() {
        set_thread_count(3);
        const Case the_case =
            D == 2 ? experiment_at("expanding-circle", 0.8) : experiment_at("ellipsoid", 0.3);
        StageClock clock;
        IdCounter ids;
        MarchState<D> state = march_from<D>(initial_cap<D>(the_case, ids, {}, clock), 0, ids);
        SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
        settings.layers.automatic = false;
        march.emplace(std::move(state), std::move(settings));
    }
    ~Trial() { set_thread_count(0); }
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    CapsAhead<D> ahead(const typename CapsAhead<D>::Levels& levels = levels_of_slab) {
        const MarchState<D>& state = march->state();
        return {state.boundary, state.cap, state.time, march->settings(), levels};
    }

    static constexpr int slabs = 5;
    static std::vector<double> levels_of_slab(double begin) {
        constexpr double length = 0.05;
        return begin < (slabs - 0.5) * length ? std::vector{begin, begin + length / 2, begin + length}
                                              : std::vector<double>{};
    }

    std::optional<March<D>> march;
};

template<int D>
bool same(const Hull<D>& a, const Hull<D>& b) {
    return a.points == b.points && a.cells == b.cells && a.neighbors == b.neighbors &&
           a.vertex_ids == b.vertex_ids && a.track_ids == b.track_ids;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("slabs whose caps were meshed ahead are the same bit for bit", "[march]", ((int D), D),
                       2, 3) {
    Trial<D> trial;
    Trial<D> alone;
    CapsAhead<D> ahead = trial.ahead();
    StageClock clock;
    for (int k = 0; k < Trial<D>::slabs; ++k) {
        const std::vector<double> times = Trial<D>::levels_of_slab(trial.march->state().time);
        std::optional<PreparedSlab<D>> prepared = ahead.take(trial.march->state().boundary, times);
        REQUIRE(prepared);
        const Slab<D> slab = trial.march->build(*std::move(prepared), clock);
        const Slab<D> expected = alone.march->build(times, clock);
        CHECK(same(slab.hull, expected.hull));
        CHECK(slab.layers.deviation == expected.layers.deviation);
        CHECK(slab.cap_blocks == expected.cap_blocks);
        trial.march->accept(slab); // keeps its hull
        CHECK(same(slab.hull, expected.hull));
        alone.march->accept(expected);
    }
    CHECK_FALSE(ahead.take(trial.march->state().boundary, {1, 2, 3}));
}

TEMPLATE_TEST_CASE_SIG("what was not prepared is not given: other times, other boundaries, a single thread",
                       "[march]", ((int D), D), 2, 3) {
    Trial<D> trial;
    const MarchState<D>& state = trial.march->state();
    const std::vector<double> times = Trial<D>::levels_of_slab(0);
    CHECK_FALSE(trial.ahead().take(state.boundary, {0, 0.01, 0.02}));

    Surface<D> other = state.boundary.start_surface();
    std::swap(other.facets.front(), other.facets.back());
    CHECK_FALSE(trial.ahead().take(Boundary<D>{other}, times));

    set_thread_count(1);
    CHECK_FALSE(trial.ahead().take(state.boundary, times));
}

TEST_CASE("a motion that fails later leaves the slabs before it", "[march]") {
    Trial<2> trial;
    trial.march->settings().motions.begin()->second = {
        velocity_field<2>([](const Point<2>&, double time) -> Point<2> {
            if (time > 0.12) {
                throw GeometryError{"no motion there"};
            }
            return {};
        })};
    CapsAhead<2> ahead = trial.ahead();
    StageClock clock;
    for (int k = 0; k < 2; ++k) {
        auto prepared =
            ahead.take(trial.march->state().boundary, Trial<2>::levels_of_slab(trial.march->state().time));
        REQUIRE(prepared);
        trial.march->accept(trial.march->build(*std::move(prepared), clock));
    }
    const std::vector<double> times = Trial<2>::levels_of_slab(trial.march->state().time);
    CHECK_FALSE(ahead.take(trial.march->state().boundary, times));
    CHECK_THROWS_AS(trial.march->build(times, clock), GeometryError); // who builds it hears why
}

TEST_CASE("who looks ahead can be stopped at any moment", "[march]") {
    Trial<3> trial;
    trial.march->settings().cap.grading.largest = 0.3; // a cap of seconds
    const Stopwatch watch;
    {
        CapsAhead<3> ahead = trial.ahead();
        const ProgressScope scope{[questions = 3](const WorkState&) mutable { return questions-- > 0; }};
        CHECK_THROWS_AS(ahead.take(trial.march->state().boundary, Trial<3>::levels_of_slab(0)), Interrupted);
    }
    CHECK(watch.seconds() < 3);
}
