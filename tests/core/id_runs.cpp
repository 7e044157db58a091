// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/id_runs.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace slabhull;

namespace {

using List = std::vector<std::int64_t>;

/// What is in the list, read in every way that there is.
void require_same(const IdRuns& ids, const List& wanted) {
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

TEST_CASE("a list of ids holds what was put in, in runs or not") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        for (const std::size_t longest : {2u, 5u, 200u, 3000u}) {
            const List wanted = random_list(5000, longest, seed);
            IdRuns ids;
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
        IdRuns whole, single;
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
    IdRuns ids;
    ids.append_run(10, 1000, 1);
    CHECK(ids.ascending());
    ids.append_run(5000, 1000, 1);
    CHECK(ids.ascending());
    ids.push_back(5999);
    CHECK_FALSE(ids.ascending());
}
