// SPDX-License-Identifier: BSD-3-Clause
#include "core/parallel_sort.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace slabhull;

TEST_CASE("lists of any length come out in order, whatever the threads", "[parallel]") {
    std::mt19937 random{5}; // NOLINT(cert-msc32-c,cert-msc51-cpp)
    for (const std::size_t size : {0u, 1u, 1000u, 65'535u, 65'536u, 300'001u}) {
        std::vector<std::pair<std::uint32_t, std::size_t>> list(size);
        for (std::size_t k = 0; k < size; ++k) {
            list[k] = {random() % 1000, k};
        }
        auto sorted = list;
        std::sort(sorted.begin(), sorted.end());
        for (const int threads : {1, 2, 3, 8}) {
            set_thread_count(threads);
            auto one = list;
            parallel_sort(one);
            REQUIRE(one == sorted);
        }
        set_thread_count(0);
    }
}
