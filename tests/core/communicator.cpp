// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/communicator.h"

#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"

#include <catch2/catch.hpp>

#include <array>
#include <atomic>
#include <bit>
#include <mutex>
#include <numeric>

using namespace slabhull;

namespace {

/// What each rank of a team caught.
class Caught {
public:
    explicit Caught(int ranks) : text_(static_cast<std::size_t>(ranks)) {}
    void put(const Communicator& ranks, const std::string& text) {
        const std::lock_guard guard{lock_};
        text_[static_cast<std::size_t>(ranks.rank())] = text;
    }
    const std::vector<std::string>& text() const { return text_; }

private:
    std::mutex lock_;
    std::vector<std::string> text_;
};

} // namespace

TEST_CASE("ranks learn each other's values in the order of ranks") {
    for (const int size : {1, 2, 3, 7}) {
        std::atomic<int> right{0};
        run_team(size, [&](Communicator& ranks) {
            const int r = ranks.rank();
            std::vector<int> expected(static_cast<std::size_t>(size));
            std::iota(expected.begin(), expected.end(), 10);
            bool good = ranks.gather(r + 10) == expected;
            good = good && ranks.sum(std::int64_t{r}) == std::int64_t{size} * (size - 1) / 2;
            good = good && ranks.min(r) == 0 && ranks.max(r) == size - 1;
            good = good && ranks.sum_before(std::uint64_t{2}) == 2u * static_cast<unsigned>(r);
            right += good ? 1 : 0;
        });
        CHECK(right == size);
    }
}

TEST_CASE("sums of floating-point numbers are the same on all ranks") {
    std::vector<double> sums(5);
    run_team(5, [&](Communicator& ranks) {
        sums[static_cast<std::size_t>(ranks.rank())] = ranks.sum(1.0 / (1 + ranks.rank()));
    });
    CHECK(std::all_of(sums.begin(), sums.end(), [&](double sum) { return sum == sums[0]; }));
}

TEST_CASE("what a rank sends to others is counted, and how often it meets them") {
    std::atomic<int> right{0};
    run_team(3, [&](Communicator& ranks) {
        const std::array<std::int32_t, 5> mine{};
        ranks.all_gather<std::int32_t>(mine);               // to two others
        ranks.broadcast<std::int32_t>({mine.data(), 4}, 1); // from one, in two steps
        const std::uint64_t expected = 2 * sizeof mine + (ranks.rank() == 1 ? 2 * 16 : 0);
        right += ranks.sent_bytes() == expected && ranks.meetings() == 3 ? 1 : 0;
    });
    CHECK(right == 3);
}

TEST_CASE("lists of any length go to all ranks, from one, and between any two") {
    std::atomic<int> right{0};
    run_team(4, [&](Communicator& ranks) {
        const auto r = static_cast<std::size_t>(ranks.rank());
        const std::vector<int> mine(r * 1000, ranks.rank());
        const auto all = ranks.all_gather<int>(mine);
        bool good = all.size() == 4;
        for (std::size_t from = 0; from < 4; ++from) {
            good = good && all[from] == Array<int>(from * 1000, static_cast<int>(from));
        }
        std::vector<Array<int>> to(4);
        for (std::size_t other = 0; other < 4; ++other) {
            to[other].assign(r + other, static_cast<int>(10 * r + other));
        }
        const auto received = ranks.all_to_all(to);
        for (std::size_t from = 0; from < 4; ++from) {
            good = good && received[from] == Array<int>(r + from, static_cast<int>(10 * from + r));
        }
        const std::vector<int> list{3, 1, 4};
        good = good &&
               ranks.broadcast<int>(ranks.rank() == 2 ? std::span<const int>{list} : std::span<const int>{},
                                    2) == Array<int>{3, 1, 4};
        right += good ? 1 : 0;
    });
    CHECK(right == 4);
}

TEST_CASE("a list goes from one rank to all, who pass it on") {
    for (const int size : {1, 2, 3, 5, 8, 9}) {
        for (int root = 0; root < size; ++root) {
            std::atomic<int> right{0};
            run_team(size, [&](Communicator& ranks) {
                const std::vector<int> list(100, root);
                const Array<int> here = ranks.broadcast<int>(
                    ranks.rank() == root ? std::span<const int>{list} : std::span<const int>{}, root);
                const auto steps =
                    static_cast<std::uint64_t>(std::bit_width(static_cast<unsigned>(size - 1)));
                const bool good = here == Array<int>(100, root) && ranks.meetings() == steps &&
                                  ranks.sent_bytes() <= steps * 100 * sizeof(int);
                right += good ? 1 : 0;
            });
            CHECK(right == size);
        }
    }
}

TEST_CASE("a prefix sum that would overflow is refused") {
    CHECK_THROWS_AS(
        run_team(3, [](Communicator& ranks) { ranks.sum_before(std::numeric_limits<std::int64_t>::max()); }),
        LimitError);
}

TEST_CASE("an error of one rank is thrown on all, whatever they wait for") {
    Caught caught{4};
    run_team(4, [&](Communicator& ranks) {
        try {
            together(ranks, [&] {
                if (ranks.rank() == 2) {
                    throw GeometryError{"facets cross", {{"facet", 12, "wall"}}};
                }
                ranks.sum(1); // never comes to an end
            });
        } catch (const GeometryError& error) {
            if (error.entities.size() == 1 && error.entities[0].number == 12 &&
                error.entities[0].patch == "wall") {
                caught.put(ranks, error.what());
            }
        }
        ranks.barrier(); // and they go on together
    });
    CHECK(caught.text() == std::vector<std::string>(4, "facets cross"));
}

TEST_CASE("of several errors, the lowest rank's is thrown") {
    Caught caught{5};
    run_team(5, [&](Communicator& ranks) {
        try {
            together(ranks, [&] {
                if (ranks.rank() % 2 == 1) {
                    throw InputError{"rank " + std::to_string(ranks.rank())};
                }
            });
        } catch (const InputError& error) {
            caught.put(ranks, error.what());
        }
    });
    CHECK(caught.text() == std::vector<std::string>(5, "rank 1"));
}

TEST_CASE("an error outside an inner scope ends the work of those inside") {
    // A loop that tries again within must not keep others waiting for a rank that has left.
    Caught caught{3};
    run_team(3, [&](Communicator& ranks) {
        try {
            together(ranks, [&] {
                if (ranks.rank() == 1) {
                    throw OutputError{"disk full"};
                }
                for (int attempt = 0; attempt < 3; ++attempt) {
                    try {
                        together(ranks, [&] { ranks.barrier(); });
                    } catch (const Error&) { // tries again
                    }
                }
                ranks.barrier();
            });
        } catch (const OutputError& error) {
            caught.put(ranks, error.what());
        }
        ranks.barrier();
    });
    CHECK(caught.text() == std::vector<std::string>(3, "disk full"));
}

TEST_CASE("classes of errors are kept") {
    run_team(2, [&](Communicator& ranks) {
        const auto throws = [&](const auto& error) {
            return [&ranks, &error] {
                together(ranks, [&] {
                    if (ranks.rank() == 1) {
                        throw error;
                    }
                });
            };
        };
        const auto is = [&](const auto& error) {
            try {
                throws(error)();
            } catch (const std::decay_t<decltype(error)>&) {
                return true;
            } catch (...) {
            }
            return false;
        };
        const bool all = is(LimitError{"a"}) && is(FormatLimit{"b"}) && is(UsageError{"c"}) &&
                         is(Interrupted{}) && is(std::bad_alloc{}) && is(std::runtime_error{"d"});
        if (!all) {
            throw GeometryError{"a class was lost"};
        }
    });
    SUCCEED();
}

TEST_CASE("ranks that call different functions are told so") {
    CHECK_THROWS_WITH(run_team(2,
                               [](Communicator& ranks) {
                                   if (ranks.rank() == 0) {
                                       ranks.barrier();
                                   } else {
                                       ranks.sum(1);
                                   }
                               }),
                      "ranks have got out of step");
}

TEST_CASE("to interrupt one rank is to interrupt all") {
    Caught caught{3};
    CHECK_THROWS_AS(run_team(3,
                             [&](Communicator& ranks) {
                                 const ProgressScope scope{
                                     [&](const WorkState&) { return ranks.rank() != 1; }};
                                 while (true) {
                                     ranks.barrier();
                                 }
                             }),
                    Interrupted);
}
