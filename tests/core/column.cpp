// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/column.h"
#include "slabhull/core/array.h"
#include "slabhull/core/error.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <sys/mman.h>

using namespace slabhull;

static_assert(!std::equality_comparable_with<VertexId, FacetId>);
static_assert(!std::is_convertible_v<Index, VertexId>);

TEST_CASE("a column over stored values gives any range of rows", "[column]") {
    const std::vector<Index> stored{1, 2, 3, 4, 5, 6};
    const auto pairs = Column<std::int64_t>::over(std::span<const Index>{stored}, 2);
    REQUIRE(pairs.rows() == 3);
    std::vector<std::int64_t> out(4);
    pairs.fill(1, 3, out.data());
    CHECK(out == std::vector<std::int64_t>{3, 4, 5, 6});
}

TEST_CASE("a column that was not given says so", "[column]") {
    CHECK_FALSE(Column<double>{}.given());
    CHECK(Column<double>::constant(3, 1.5).given());
}

TEST_CASE("large arrays lie in huge-page aligned memory and keep their values when they grow", "[array]") {
    Array<std::uint32_t> numbers(std::size_t{3} << 20);
    CHECK(reinterpret_cast<std::uintptr_t>(numbers.data()) % (std::size_t{2} << 20) == 0);
    std::iota(numbers.begin(), numbers.end(), 0U);
    numbers.resize(std::size_t{5} << 20);
    CHECK(numbers[(std::size_t{3} << 20) - 1] == (3U << 20) - 1);
}

TEST_CASE("an array that is shortened gives its memory back and keeps the rest", "[array]") {
    constexpr std::size_t size = std::size_t{64} << 20;
    Array<char> bytes;
    bytes.assign(size, 'a');
    const auto resident = [&](std::size_t begin) {
        std::vector<unsigned char> pages((size - begin) / 4096);
        REQUIRE(::mincore(bytes.data() + begin, size - begin, pages.data()) == 0);
        return std::count_if(pages.begin(), pages.end(), [](unsigned char page) { return (page & 1) != 0; });
    };
    constexpr std::size_t kept = (std::size_t{20} << 20) + 5;
    shorten(bytes, kept);
    CHECK(bytes.size() == kept);
    CHECK(std::count(bytes.begin(), bytes.end(), 'a') == kept);
    CHECK(resident(std::size_t{22} << 20) == 0);
    shorten(bytes, 0);
    CHECK(resident(0) == 0);
    bytes.assign(size, 'b');
    CHECK(bytes.back() == 'b');
}

TEST_CASE("a count that does not fit the index type is refused by name", "[index]") {
    CHECK(checked_index(7, "cells") == 7);
    CHECK_THROWS_WITH(checked_index(std::size_t{1} << 32, "hull vertices"), Catch::Contains("hull vertices"));
    CHECK_THROWS_AS(checked_index(no_index, "cells"), LimitError);
}
