// SPDX-License-Identifier: BSD-3-Clause
#include "core/ascending_numbers.h"

#include <catch2/catch.hpp>

#include <random>
#include <set>

using namespace slabhull;

TEST_CASE("the place of each number is found, and that of no other") {
    std::mt19937_64 random{7};
    for (const std::uint64_t range :
         {std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{1} << 33, ~std::uint64_t{0}}) {
        for (const std::size_t count : {0, 1, 2, 90, 1000}) {
            CAPTURE(range, count);
            std::set<std::uint64_t> numbers;
            for (std::size_t k = 0; k < count; ++k) { // some far from the others
                numbers.insert(k % 5 == 0 ? random() % range : range / 2 + random() % 300 % range);
            }
            const AscendingNumbers ascending{{numbers.begin(), numbers.end()}};
            REQUIRE(ascending.size() == numbers.size());
            Index place = 0;
            for (const std::uint64_t number : numbers) {
                REQUIRE(ascending.place(number) == place);
                REQUIRE(ascending[place] == number);
                ++place;
                for (const std::uint64_t other : {number - 1, number + 1, random()}) {
                    REQUIRE((ascending.place(other) != no_index) == (numbers.count(other) == 1));
                }
            }
            REQUIRE((ascending.place(0) != no_index) == (numbers.count(0) == 1));
            REQUIRE((ascending.place(~std::uint64_t{0}) != no_index) ==
                    (numbers.count(~std::uint64_t{0}) == 1));
        }
    }
}
