// SPDX-License-Identifier: BSD-3-Clause
#include "../../geometry/child_process.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>

#include <sys/types.h>
#include <unistd.h>

using namespace slabhull;

namespace {

const auto receive_nothing = [](const Receive& receive) {
    char byte = 0;
    return receive(&byte, 1);
};

} // namespace

TEST_CASE("a child hands back what it computed, megabytes of it", "[child]") {
    const Array<int> numbers = [] {
        Array<int> n(3'000'000);
        std::iota(n.begin(), n.end(), 7);
        return n;
    }();
    Array<int> back(numbers.size());
    const ChildEnd end =
        run_in_child([&](const Send& send) { send(numbers.data(), numbers.size() * sizeof(int)); },
                     [&](const Receive& receive) { return receive(back.data(), back.size() * sizeof(int)); });
    CHECK(end.received);
    CHECK(end.signal == 0);
    CHECK(end.exit_code == 0);
    CHECK(back == numbers);
}

TEST_CASE("a crash in the child costs nothing but the child", "[child]") {
    int mine = 1;
    const ChildEnd end = run_in_child(
        [&](const Send&) {
            mine = 2;
            std::cout << "not to be seen" << std::endl;
            std::raise(SIGSEGV);
        },
        receive_nothing);
    CHECK_FALSE(end.received);
    CHECK(end.signal == SIGSEGV);
    CHECK(mine == 1);
}

TEST_CASE("what a job throws ends the child, with nothing sent", "[child]") {
    const ChildEnd end = run_in_child([](const Send&) { throw std::runtime_error{"no"}; }, receive_nothing);
    CHECK_FALSE(end.received);
    CHECK(end.signal == 0);
    CHECK(end.exit_code != 0);
}

TEST_CASE("a child that leaves in the middle of a message is noticed", "[child]") {
    std::array<char, 100> bytes{};
    const ChildEnd end =
        run_in_child([&](const Send& send) { send(bytes.data(), 40); },
                     [&](const Receive& receive) { return receive(bytes.data(), bytes.size()); });
    CHECK_FALSE(end.received);
    CHECK(end.exit_code == 0);
}

TEST_CASE("when the receiver throws, the child is ended and waited for", "[child]") {
    pid_t child = 0;
    CHECK_THROWS_AS(run_in_child(
                        [](const Send& send) {
                            const pid_t self = getpid();
                            send(&self, sizeof self);
                            pause();
                        },
                        [&](const Receive& receive) -> bool {
                            receive(&child, sizeof child);
                            throw std::bad_alloc{};
                        }),
                    std::bad_alloc);
    CHECK(child > 0);
    CHECK(kill(child, 0) != 0); // no such process
}

TEST_CASE("the host's signal handlers do not run in the child", "[child]") {
    const auto before = std::signal(SIGTERM, [](int) { _exit(77); });
    const ChildEnd end = run_in_child([](const Send&) { std::raise(SIGTERM); }, receive_nothing);
    std::signal(SIGTERM, before);
    CHECK(end.signal == SIGTERM);
}

TEST_CASE("children run at the same time from several threads", "[child]") {
    Array<int> sums;
    sums.assign(8, 0);
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t) {
        run_in_child(
            [&](const Send& send) {
                const int sum = static_cast<int>(begin) * 10;
                send(&sum, sizeof sum);
            },
            [&](const Receive& receive) { return receive(&sums[begin], sizeof(int)); });
    });
    for (std::size_t k = 0; k < sums.size(); ++k) {
        CHECK(sums[k] == static_cast<int>(k) * 10);
    }
}

TEST_CASE("a child does not outlive its parent", "[child]") {
    pid_t grandchild = 0;
    run_in_child(
        [](const Send& send) {
            run_in_child(
                [](const Send& tell) {
                    const pid_t self = getpid();
                    tell(&self, sizeof self);
                    pause();
                },
                [&](const Receive& receive) {
                    pid_t id = 0;
                    receive(&id, sizeof id);
                    send(&id, sizeof id);
                    std::raise(SIGINT);
                    return true;
                });
        },
        [&](const Receive& receive) { return receive(&grandchild, sizeof grandchild); });
    REQUIRE(grandchild > 0);
    // whoever adopts it may take a moment to bury it; a zombie does no work
    bool gone = false;
    for (int tries = 0; tries < 100 && !gone; ++tries) {
        usleep(10'000);
        const std::string state = [&] {
            std::ifstream stat{"/proc/" + std::to_string(grandchild) + "/stat"};
            std::string id, name, letter;
            stat >> id >> name >> letter;
            return letter;
        }();
        gone = state.empty() || state == "Z";
    }
    CHECK(gone);
}
