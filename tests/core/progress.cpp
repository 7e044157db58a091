// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/progress.h"

#include "slabhull/core/child_process.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

using namespace slabhull;

namespace {

void work_for(std::chrono::milliseconds span) {
    std::this_thread::sleep_for(span);
}

/// Goes on for some questions, then not.
Progress patience(int questions) {
    return [left = questions](const WorkState&) mutable { return left-- > 0; };
}

} // namespace

TEST_CASE("without a scope nothing stops") {
    CHECK_NOTHROW(go_on());
    CHECK_NOTHROW(enter_stage("alone"));
}

TEST_CASE("a parallel loop stops on all its threads, and the next one, too") {
    const int threads = GENERATE(1, 4);
    set_thread_count(threads);
    const ProgressScope scope{patience(2)};
    std::atomic<int> pieces{0};
    const auto loop = [&] {
        parallel_for(100'000, 1, [&](std::size_t, std::size_t) {
            ++pieces;
            work_for(std::chrono::milliseconds{1});
        });
    };
    CHECK_THROWS_AS(loop(), Interrupted);
    CHECK(pieces > 0);
    CHECK(pieces < 10'000);
    pieces = 0;
    CHECK_THROWS_AS(loop(), Interrupted);
    CHECK(pieces == 0);
    set_thread_count(0);
}

TEST_CASE("scopes: an inner one asks the outer one, an empty one asks nobody, and each ends") {
    const ProgressScope outer{patience(1)};
    {
        const ProgressScope inner{patience(1'000'000)};
        CHECK_NOTHROW(go_on());
        const auto until_stopped = [] {
            for (;;) {
                go_on();
            }
        };
        CHECK_THROWS_AS(until_stopped(), Interrupted);
        const ProgressScope to_the_end{{}};
        CHECK_NOTHROW(go_on());
    }
    CHECK_THROWS_AS(go_on(), Interrupted);
}

TEST_CASE("the stage is told when it is entered") {
    std::vector<std::string> told;
    {
        const ProgressScope scope{[&told](const WorkState& state) {
            told.push_back(state.stage);
            return true;
        }};
        enter_stage("first");
        enter_stage("second");
    }
    CHECK(told == std::vector<std::string>{"first", "second"});
}

TEST_CASE("what a stage has done is counted on all threads, in child processes, and for all scopes") {
    WorkState outer_state;
    WorkState inner_state;
    const auto keep = [](WorkState& place) {
        return [&place](const WorkState& state) {
            place = state;
            return true;
        };
    };
    const ProgressScope outer{keep(outer_state)};
    const ProgressScope inner{keep(inner_state)};
    enter_stage("counted", 100);
    CHECK(inner_state.share() == 0);
    parallel_for(40, 1, [](std::size_t begin, std::size_t end) { work_done(end - begin); });
    CHECK(ask_child([] {
              work_done(5);
              enter_stage("the child's own"); // is not the parent's
              work_done(1000);
              return std::string{};
          }).end.received);
    work_for(std::chrono::milliseconds{60});
    go_on();
    for (const WorkState* state : {&inner_state, &outer_state}) {
        CHECK(state->stage == "counted");
        CHECK(state->done == 45);
        CHECK(state->share() == 0.45);
    }
    expect_work(30);
    enter_stage("counts nothing");
    CHECK_FALSE(inner_state.share());
    CHECK(inner_state.done == 0);
}

TEST_CASE("a stage in the background is counted apart, and shown when asked for") {
    WorkState told;
    const ProgressScope scope{[&told](const WorkState& state) {
        told = state;
        return true;
    }};
    enter_stage("in front", 10);
    const BackgroundStage behind{"behind", 4};
    std::thread{behind.counted([] { work_done(3); })}.join();
    work_done(1);
    work_for(std::chrono::milliseconds{60});
    go_on();
    CHECK(told.stage == "in front");
    CHECK(told.done == 1);
    behind.show();
    CHECK(told.stage == "behind");
    CHECK(told.share() == 0.75);
    CHECK(behind.done() == 3);
}

TEST_CASE("a child that says nothing is ended") {
    const ProgressScope scope{patience(3)};
    pid_t child = 0;
    const Stopwatch watch;
    const auto run = [&] {
        run_in_child(
            [](const Send& send) {
                const pid_t self = getpid();
                send(&self, sizeof self);
                for (;;) {
                    pause();
                }
            },
            [&](const Receive& receive) {
                receive(&child, sizeof child);
                char never = 0;
                return receive(&never, 1);
            });
    };
    CHECK_THROWS_AS(run(), Interrupted);
    CHECK(watch.seconds() < 10);
    REQUIRE(child > 0);
    CHECK(kill(child, 0) != 0);
}

TEST_CASE("a child is not asked: its parent is") {
    const ProgressScope scope{patience(1'000'000)};
    const ChildAnswer answer = ask_child([] {
        parallel_for(10, 1, [](std::size_t, std::size_t) { work_for(std::chrono::milliseconds{1}); });
        return std::string{"done"};
    });
    CHECK(answer.text == "done");
}

TEST_CASE("another thread's work is watched where it is handed over so") {
    const ProgressScope scope{patience(0)};
    bool stopped = false;
    const auto work = [&stopped] {
        try {
            go_on();
        } catch (const Interrupted&) {
            stopped = true;
        }
    };
    std::thread{work}.join();
    CHECK_FALSE(stopped);
    std::thread{watched_as_here(work)}.join();
    CHECK(stopped);
}
