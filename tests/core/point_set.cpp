// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/point_set.h"

#include <catch2/catch.hpp>

#include <cstddef>
#include <random>
#include <vector>

using namespace slabhull;

namespace {

/// All functions of a counted set, by its members in ascending order.
void require_members(const PointSet& set, const std::vector<std::size_t>& members) {
    REQUIRE(set.size() == members.size());
    std::vector<std::size_t> ranks; // of all points, and of their end
    std::vector<std::size_t> expected_ranks;
    std::vector<bool> contained;
    std::vector<bool> expected(set.all(), false);
    std::size_t before = 0;
    for (std::size_t point = 0; point <= set.all(); ++point) {
        ranks.push_back(set.rank(point));
        expected_ranks.push_back(before);
        before += before < members.size() && members[before] == point ? 1 : 0;
    }
    CHECK(ranks == expected_ranks);
    for (std::size_t point = 0; point < set.all(); ++point) {
        contained.push_back(set.contains(point));
    }
    std::vector<std::size_t> by_rank;
    std::vector<std::size_t> one_after_the_other;
    for (std::size_t k = 0; k < members.size(); ++k) {
        expected[members[k]] = true;
        by_rank.push_back(set.member(k));
        one_after_the_other.push_back(k == 0 ? set.member(0) : set.next(one_after_the_other.back()));
    }
    CHECK(contained == expected);
    CHECK(by_rank == members);
    CHECK(one_after_the_other == members);
}

} // namespace

TEST_CASE("a set of points knows its members and their numbers", "[point_set]") {
    std::mt19937 random{5};
    for (const std::size_t points : {0, 1, 63, 64, 65, 511, 512, 513, 1024, 5000}) {
        for (const double density : {0.0, 0.01, 0.5, 1.0}) {
            INFO(points << " points, " << density << " of them members");
            std::bernoulli_distribution chosen{density};
            PointSet set{points};
            std::vector<std::size_t> members;
            std::vector<std::size_t> others;
            for (std::size_t point = 0; point < points; ++point) {
                const bool member = chosen(random);
                (member ? members : others).push_back(point);
                if (member) {
                    set.insert(point);
                }
            }
            set.count();
            require_members(set, members);
            PointSet complement{points};
            complement.insert_complement(set);
            complement.count();
            require_members(complement, others);
            complement.insert(set);
            complement.count();
            CHECK(complement.size() == points);
        }
    }
}
