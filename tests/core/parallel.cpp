// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace slabhull;

namespace {

struct Threads {
    explicit Threads(int count) { set_thread_count(count); }
    ~Threads() { set_thread_count(0); }
};

} // namespace

TEST_CASE("every index is visited once, whatever the threads and the grain", "[parallel]") {
    for (const int threads : {1, 2, 7}) {
        const Threads scope{threads};
        for (const std::size_t grain : {0u, 1u, 3u, 1000u}) {
            std::vector<std::atomic<int>> visits(101);
            parallel_for(visits.size(), grain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    ++visits[i];
                }
            });
            for (const auto& count : visits) {
                REQUIRE(count == 1);
            }
        }
    }
}

TEST_CASE("the pieces are the same for any number of threads", "[parallel]") {
    const auto pieces = [](int threads) {
        const Threads scope{threads};
        std::set<std::pair<std::size_t, std::size_t>> seen;
        std::mutex lock;
        parallel_for(1000, 64, [&](std::size_t begin, std::size_t end) {
            const std::lock_guard guard{lock};
            seen.emplace(begin, end);
        });
        return seen;
    };
    CHECK(pieces(1) == pieces(4));
}

TEST_CASE("the exception of the first failing piece comes out, after all threads have ended", "[parallel]") {
    const Threads scope{4};
    std::atomic<int> running{0};
    const auto fail_in_two = [&] {
        parallel_for(100, 1, [&](std::size_t begin, std::size_t) {
            ++running;
            if (begin == 30 || begin == 70) {
                --running;
                throw std::runtime_error(std::to_string(begin));
            }
            --running;
        });
    };
    CHECK_THROWS_WITH(fail_in_two(), "30");
    CHECK(running == 0);
}

TEST_CASE("nothing to do is done", "[parallel]") {
    parallel_for(0, 8, [](std::size_t, std::size_t) { FAIL("called"); });
}
