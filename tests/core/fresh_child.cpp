// SPDX-License-Identifier: BSD-3-Clause
#include "core/process_state.h"

#include "slabhull/core/array.h"
#include "slabhull/core/child_process.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/stopwatch.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>
#include <unistd.h>

using namespace slabhull;

namespace {

template<class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span{values});
}

/// Sends the request back, in reverse.
void reverse(std::span<const std::byte> request, const Send& send) {
    std::vector<std::byte> back(request.rbegin(), request.rend());
    send(back.data(), back.size());
}

void say_number_and_wait(std::span<const std::byte>, const Send& send) {
    const pid_t self = getpid();
    send(&self, sizeof self);
    for (;;) {
        pause();
    }
}

void raise_signal(std::span<const std::byte> request, const Send&) {
    int number = 0;
    std::memcpy(&number, request.data(), sizeof number);
    std::raise(number);
}

void fail(std::span<const std::byte>, const Send&) {
    throw std::runtime_error{"no"};
}

void count(std::span<const std::byte>, const Send& send) {
    for (int k = 0; k < 10'000; ++k) {
        work_done(10);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
    send("!", 1);
}

void take_memory(std::span<const std::byte>, const Send& send) {
    std::vector<char> much(std::size_t{60} << 20, 'x');
    send(&much[much.size() / 2], 1);
}

void count_files(std::span<const std::byte>, const Send& send) {
    const std::filesystem::directory_iterator files{"/proc/self/fd"};
    const auto open = std::distance(begin(files), end(files));
    send(&open, sizeof open);
}

} // namespace

TEST_CASE("a fresh child knows its request, in parts, and hands back megabytes", "[child]") {
    std::vector<int> numbers(2'000'000);
    std::iota(numbers.begin(), numbers.end(), 7);
    const std::vector<char> letters{'a', 'b', 'c', 'd'};
    std::vector<char> back(sizeof(int) * numbers.size() + letters.size());
    const ChildEnd end =
        run_in_fresh_child(reverse, {bytes_of(letters), {}, bytes_of(numbers)},
                           [&](const Receive& receive) { return receive(back.data(), back.size()); });
    CHECK(end.received);
    CHECK(end.signal == 0);
    CHECK(end.exit_code == 0);
    std::reverse(back.begin(), back.end());
    CHECK(std::equal(letters.begin(), letters.end(), back.begin()));
    CHECK(std::memcmp(back.data() + letters.size(), numbers.data(), back.size() - letters.size()) == 0);
}

TEST_CASE("how a fresh child ended is told: crashes, exceptions, signals", "[child]") {
    const std::vector<int> crash{SIGSEGV};
    CHECK(run_in_fresh_child(raise_signal, {bytes_of(crash)}, receive_nothing).signal == SIGSEGV);
    const std::vector<int> asked{SIGTERM};
    CHECK(run_in_fresh_child(raise_signal, {bytes_of(asked)}, receive_nothing).signal == SIGTERM);
    const ChildEnd failed = run_in_fresh_child(fail, {}, receive_nothing);
    CHECK_FALSE(failed.received);
    CHECK(failed.signal == 0);
    CHECK(failed.exit_code != 0);
}

TEST_CASE("when the receiver throws, or the work is to stop, a fresh child is ended", "[child]") {
    pid_t child = 0;
    const auto throws = [&](const Receive& receive) -> bool {
        receive(&child, sizeof child);
        throw std::bad_alloc{};
    };
    CHECK_THROWS_AS(run_in_fresh_child(say_number_and_wait, {}, throws), std::bad_alloc);
    REQUIRE(child > 0);
    CHECK(ends_soon(child));

    child = 0;
    const Stopwatch watch;
    const ProgressScope scope{[&](const WorkState&) { return child == 0 || watch.seconds() < 0.3; }};
    const auto waits = [&](const Receive& receive) {
        receive(&child, sizeof child);
        char never = 0;
        return receive(&never, 1);
    };
    CHECK_THROWS_AS(run_in_fresh_child(say_number_and_wait, {}, waits), Interrupted);
    CHECK(watch.seconds() < 3);
    REQUIRE(child > 0);
    CHECK(ends_soon(child));
}

TEST_CASE("what a fresh child has done is counted here", "[child]") {
    std::uint64_t most = 0;
    const ProgressScope scope{[&most](const WorkState& state) {
        most = std::max(most, state.done);
        return true;
    }};
    enter_stage("counting", 100'000);
    CHECK(run_in_fresh_child(count, {}, receive_nothing).received);
    CHECK(most > 90'000);
    CHECK(most <= 100'000);
}

TEST_CASE("memory and processor time of fresh children are told, and they start small", "[child]") {
    start_child_server();
    const std::vector<char> mine(std::size_t{30} << 20, 'y'); // which they do not have
    const double before = cpu_seconds_of_children();
    CHECK(run_in_fresh_child(take_memory, {}, receive_nothing).received);
    CHECK(peak_memory_of_children() > std::size_t{60} << 20);
    CHECK(cpu_seconds_of_children() > before);
    CHECK(mine.back() == 'y');
}

TEST_CASE("fresh children hold no files of the host, and leave none open here", "[child]") {
    const auto open_here = [] {
        const std::filesystem::directory_iterator files{"/proc/self/fd"};
        return std::distance(begin(files), end(files));
    };
    run_in_fresh_child(fail, {}, receive_nothing);
    const auto before = open_here();
    const std::ifstream mine{"/proc/self/stat"};
    std::ptrdiff_t theirs = 0;
    CHECK(run_in_fresh_child(count_files, {}, [&](const Receive& receive) {
              return receive(&theirs, sizeof theirs);
          }).received);
    CHECK(theirs <= 3 + 2 + 1); // the standard streams, two sockets, the folder that is read
    CHECK(open_here() == before + 1);
}

TEST_CASE("fresh children run at the same time, from several threads", "[child]") {
    std::atomic<int> right{0};
    std::vector<std::jthread> team;
    for (int k = 0; k < 8; ++k) {
        team.emplace_back([k, &right] {
            const std::vector<int> numbers(100'000, k);
            std::vector<int> back(numbers.size());
            const auto receive_all = [&](const Receive& receive) {
                return receive(back.data(), back.size() * sizeof back[0]);
            };
            const ChildEnd end = run_in_fresh_child(reverse, {bytes_of(numbers)}, receive_all);
            std::vector<std::byte> bytes(bytes_of(back).rbegin(), bytes_of(back).rend());
            right += end.received && std::memcmp(bytes.data(), numbers.data(), bytes.size()) == 0;
        });
    }
    team.clear();
    CHECK(right == 8);
}

TEST_CASE("a fresh child ends with its host, and copies of the host have fresh children of their own",
          "[child]") {
    run_in_fresh_child(fail, {}, receive_nothing); // a server of this process, which the copy must not use
    pid_t grandchild = 0;
    run_in_child(
        [](const Send& send) {
            run_in_fresh_child(say_number_and_wait, {}, [&](const Receive& receive) {
                pid_t id = 0;
                receive(&id, sizeof id);
                send(&id, sizeof id);
                std::raise(SIGKILL);
                return true;
            });
        },
        [&](const Receive& receive) { return receive(&grandchild, sizeof grandchild); });
    REQUIRE(grandchild > 0);
    CHECK(ends_soon(grandchild));
}

TEST_CASE("a server that was killed is replaced", "[child]") {
    pid_t child = 0;
    const auto kill_server = [&](const Receive& receive) {
        receive(&child, sizeof child);
        const auto parent_of = [](pid_t process) {
            std::ifstream stat{"/proc/" + std::to_string(process) + "/stat"};
            std::string id, name, state;
            pid_t parent = 0;
            stat >> id >> name >> state >> parent;
            return parent;
        };
        kill(parent_of(parent_of(child)), SIGKILL);
        return true;
    };
    const ChildEnd end = run_in_fresh_child(say_number_and_wait, {}, kill_server);
    CHECK(end.signal == SIGKILL);
    CHECK(ends_soon(child));
    const std::vector<int> crash{SIGSEGV};
    CHECK(run_in_fresh_child(raise_signal, {bytes_of(crash)}, receive_nothing).signal == SIGSEGV);
}
