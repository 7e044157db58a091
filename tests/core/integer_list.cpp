// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/integer_list.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace slabhull;

namespace {

using List = std::vector<std::int64_t>;

/// What is in the list, read in every way that there is.
void require_same(const IntegerList& ids, const List& wanted) {
    REQUIRE(ids.size() == wanted.size());
    REQUIRE(ids.empty() == wanted.empty());
    REQUIRE(List(ids.begin(), ids.end()) == wanted);
    for (std::size_t k = 0; k < wanted.size(); k += 7) {
        REQUIRE(ids[k] == wanted[k]);
        const std::size_t end = std::min(wanted.size(), k + 1 + k % 13);
        List part(end - k);
        ids.copy(k, end, part.data());
        REQUIRE(std::equal(part.begin(), part.end(), wanted.begin() + static_cast<std::ptrdiff_t>(k)));
    }
    REQUIRE(ids.ascending() ==
            (std::adjacent_find(wanted.begin(), wanted.end(), std::greater_equal<>{}) == wanted.end()));
}

/// Runs of up to `longest` ids.
List random_list(std::size_t count, std::size_t longest, unsigned seed) {
    std::mt19937 random{seed};
    List list;
    while (list.size() < count) {
        const auto first = static_cast<std::int64_t>(random() % 1000) - 1;
        const auto step = static_cast<std::int64_t>(random() % 2);
        for (std::size_t k = random() % longest; k-- > 0; list.push_back(first + step * std::ssize(list))) {
        }
    }
    return list;
}

} // namespace

TEST_CASE("a list of integers holds what was put in, in runs or not") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        for (const std::size_t longest : {2u, 5u, 200u, 3000u}) {
            const List wanted = random_list(5000, longest, seed);
            IntegerList ids;
            ids.append(wanted);
            require_same(ids, wanted);
        }
    }
    require_same({}, {});
    require_same({5}, {5});
    require_same({5, 5, 6, 7, -1, -1}, {5, 5, 6, 7, -1, -1});
}

TEST_CASE("a run put in as a whole is as if its ids came one by one") {
    std::mt19937 random{1};
    for (int round = 0; round < 200; ++round) {
        IntegerList whole, single;
        List wanted;
        for (int runs = 0; runs < 6; ++runs) {
            const auto first = static_cast<std::int64_t>(random() % 4) + (runs > 0 ? wanted.back() - 1 : 0);
            const std::size_t count = 1 + random() % 5;
            const auto step = static_cast<std::int64_t>(random() % 2);
            whole.append_run(first, count, step);
            for (std::size_t k = 0; k < count; ++k) {
                wanted.push_back(first + step * static_cast<std::int64_t>(k));
                single.push_back(wanted.back());
            }
        }
        require_same(whole, wanted);
        REQUIRE(whole == single);
        single.push_back(0);
        REQUIRE_FALSE(whole == single);
    }
}

TEST_CASE("ids that ascend are told from those that do not") {
    IntegerList ids;
    ids.append_run(10, 1000, 1);
    CHECK(ids.ascending());
    ids.append_run(5000, 1000, 1);
    CHECK(ids.ascending());
    ids.push_back(5999);
    CHECK_FALSE(ids.ascending());
}

TEST_CASE("a list takes 32 bits for each integer while they fit, and 64 from the first that does not") {
    constexpr std::int64_t widest = std::numeric_limits<std::int32_t>::max();
    std::mt19937 random{5};
    List wanted;
    IntegerList pushed;
    for (int k = 0; k < 5000; ++k) {
        wanted.push_back(static_cast<std::int64_t>(random()) % widest - 1);
        pushed.push_back(wanted.back());
    }
    require_same(pushed, wanted);
    CHECK(pushed.narrow().size() == wanted.size());
    for (const std::int64_t value : {widest, widest + 1, -widest - 2, std::int64_t{3}}) {
        wanted.push_back(value);
        pushed.push_back(value);
        CHECK(pushed.narrow().empty() == (value != widest || pushed.size() > 5001));
    }
    require_same(pushed, wanted);
    require_same(IntegerList{Array<std::int64_t>(wanted.begin(), wanted.end())}, wanted);
    require_same(IntegerList::generated(wanted.size(), [&](std::size_t k) { return wanted[k]; }), wanted);
    wanted.resize(5001);
    const IntegerList narrow{Array<std::int32_t>(wanted.begin(), wanted.end())};
    require_same(narrow, wanted);
    CHECK(narrow.narrow().size() == wanted.size());
    CHECK(narrow == IntegerList{Array<std::int64_t>(wanted.begin(), wanted.end())});
}

TEST_CASE("an array of runs becomes runs") {
    const List wanted = random_list(100'000, 3000, 3);
    const IntegerList list{Array<std::int64_t>(wanted.begin(), wanted.end())};
    require_same(list, wanted);
    CHECK(list.narrow().empty());
}

TEST_CASE("lists of either kind are joined") {
    for (const std::size_t first : {2u, 3000u}) {
        for (const std::size_t second : {2u, 3000u}) {
            for (const std::int64_t offset : {std::int64_t{0}, std::int64_t{1} << 40}) {
                List wanted = random_list(5000, first, 1);
                List more = random_list(5000, second, 2);
                for (std::int64_t& value : more) {
                    value += offset;
                }
                IntegerList list{Array<std::int64_t>(wanted.begin(), wanted.end())};
                list.append_list(Array<std::int64_t>(more.begin(), more.end()));
                wanted.insert(wanted.end(), more.begin(), more.end());
                require_same(list, wanted);
            }
        }
    }
}

TEST_CASE("the ends of the range of integers are no neighbours") {
    constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    require_same({most - 1, most, least, least + 1}, {most - 1, most, least, least + 1});
    require_same({most, least, most}, {most, least, most});
}

TEST_CASE("a column has the rows of a list from the first wanted on") {
    const IntegerList list{10, 11, 12, 13, 5, 6};
    const Column<std::int64_t> pairs = integer_column(list, 2, 1);
    CHECK(pairs.rows() == 2);
    CHECK(pairs.components() == 2);
    List values(4);
    pairs.fill(0, 2, values.data());
    CHECK(values == List{12, 13, 5, 6});
}
