// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/child_process.h"

#include "core/no_more_files.h"
#include "core/process_state.h"

#include "slabhull/core/array.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"

#include <catch2/catch.hpp>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/types.h>
#include <unistd.h>

using namespace slabhull;

namespace {

long open_files() {
    const std::filesystem::directory_iterator files{"/proc/self/fd"};
    return std::distance(begin(files), end(files));
}

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

TEST_CASE("what the host ignores, the child ignores", "[child]") {
    const auto before = std::signal(SIGHUP, SIG_IGN); // as nohup does
    const ChildEnd end = run_in_child(
        [](const Send& send) {
            std::raise(SIGHUP);
            send("!", 1);
        },
        receive_nothing);
    std::signal(SIGHUP, before);
    CHECK(end.received);
    CHECK(end.signal == 0);
}

TEST_CASE("a child prints until it falls silent, and then leaves no core", "[child]") {
    std::FILE* const printed = std::tmpfile();
    REQUIRE(printed != nullptr);
    std::cout << std::flush; // what Catch has printed so far is not the child's
    rlimit core{1, 1};
    run_in_child(
        [&](const Send& send) {
            dup2(fileno(printed), STDOUT_FILENO);
            dup2(fileno(printed), STDERR_FILENO);
            std::cout << "seen" << std::endl;
            fall_silent();
            std::cout << "not to be seen" << std::endl;
            std::cerr << "nor that" << std::endl;
            getrlimit(RLIMIT_CORE, &core);
            send(&core, sizeof core);
        },
        [&](const Receive& receive) { return receive(&core, sizeof core); });
    CHECK(core.rlim_cur == 0);
    std::array<char, 100> text{};
    std::rewind(printed);
    const std::size_t size = std::fread(text.data(), 1, text.size(), printed);
    CHECK(std::string(text.data(), size) == "seen\n");
    std::fclose(printed);
}

TEST_CASE("a child that goes on sending ends when its parent has enough", "[child]") {
    const ChildEnd end = run_in_child(
        [](const Send& send) {
            alarm(20);
            for (const Array<char> plenty(1 << 20);;) {
                send(plenty.data(), plenty.size());
            }
        },
        receive_nothing);
    CHECK(end.received);
    CHECK((end.signal == SIGPIPE || end.exit_code != 0)); // where SIGPIPE is ignored
}

TEST_CASE("no file of a child's stays open", "[child]") {
    const long before = open_files();
    run_in_child([](const Send& send) { send("!", 1); }, receive_nothing);
    CHECK(open_files() == before);
}

#ifndef __SANITIZE_ADDRESS__ // sanitizers look at objects through pipes of their own
TEST_CASE("a system that gives no pipe is named as the cause", "[child]") {
    const auto start = [] {
        const testing::NoMoreFiles shortage;
        run_in_child([](const Send&) {}, receive_nothing);
    };
    CHECK_THROWS_WITH(start(), "no pipe: Too many open files");
}
#endif

TEST_CASE("a child of a process without other threads may start threads", "[child]") {
    const ChildAnswer answer = ask_child([] {
        set_thread_count(4);
        Array<int> squares(1000);
        parallel_for(squares.size(), 10, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                squares[k] = static_cast<int>(k * k);
            }
        });
        return std::to_string(std::accumulate(squares.begin(), squares.end(), 0));
    });
    CHECK(answer.text == "332833500");
}

TEST_CASE("a child answers in words, megabytes of them or none", "[child]") {
    for (const std::string& words : {std::string{}, std::string{"w"}, std::string(3'000'000, 'w')}) {
        const ChildAnswer answer = ask_child([&] { return words; });
        CHECK(answer.end.received);
        CHECK(answer.end.exit_code == 0);
        CHECK((answer.text == words));
    }
}

TEST_CASE("why a job failed arrives with the exit code of its error", "[child]") {
    const ChildAnswer refused = ask_child([]() -> std::string { throw OutputError{"disk full"}; });
    CHECK(refused.end.received);
    CHECK(refused.text == "disk full");
    CHECK(refused.end.exit_code == static_cast<int>(Failure::output));
    const ChildAnswer failed = ask_child([]() -> std::string { throw std::bad_alloc{}; });
    CHECK(failed.text == std::bad_alloc{}.what());
    CHECK(failed.end.exit_code == static_cast<int>(Failure::geometry));
}

TEST_CASE("a child that dies has no answer", "[child]") {
    const ChildAnswer killed = ask_child([] {
        std::raise(SIGKILL);
        return std::string{"too late"};
    });
    CHECK_FALSE(killed.end.received);
    CHECK(killed.end.signal == SIGKILL);
    const ChildAnswer left = ask_child([]() -> std::string { _exit(1); });
    CHECK_FALSE(left.end.received);
    CHECK(left.end.exit_code == 1);
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
    CHECK(ends_soon(grandchild));
}

TEST_CASE("a child can allocate, whatever other threads were allocating when it was made", "[child]") {
    const auto allocate = [] {
        std::vector<std::unique_ptr<char[]>> held;
        for (std::size_t k = 0; k < 3000; ++k) {
            held.emplace_back(new char[16 + 37 * k % 3000]);
        }
    };
    for (int round = 0; round < 20; ++round) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{30};
        const ProgressScope limit{
            [&](const WorkState&) { return std::chrono::steady_clock::now() < deadline; }};
        std::vector<std::jthread> others;
        for (int k = 0; k < 3; ++k) {
            others.emplace_back(allocate);
        }
        std::this_thread::sleep_for(std::chrono::microseconds{150 * round});
        const ChildEnd end = run_in_child([&](const Send&) { allocate(); }, receive_nothing);
        REQUIRE(end.exit_code == 0);
    }
}
