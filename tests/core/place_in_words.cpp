// SPDX-License-Identifier: BSD-3-Clause
#include "core/place_in_words.h"

#include <catch2/catch.hpp>

#include <array>

using namespace slabhull;

TEST_CASE("a place in words is short near the origin, and tells thousandths far from it") {
    CHECK(place_in_words(std::array{0.5, -1.0, 2.0 / 3}) == "(0.5, -1, 0.666667)");
    CHECK(place_in_words(std::array{512345.678, -4321.0625}) == "(512345.678, -4321.0625)");
    CHECK(place_in_words(std::array{1e9 / 7, 0.0}) == "(142857143, 0)");
}
