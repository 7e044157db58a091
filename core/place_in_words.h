// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <fmt/format.h>
#include <string>

namespace slabhull {

/// A place as messages give it, "(0.5, 1, 2)": six digits of each coordinate, or nine far from the origin,
/// where six would leave less than thousandths.
template<class Coordinates>
std::string place_in_words(const Coordinates& place) {
    constexpr double far = 1000;
    std::string words;
    for (const double x : place) {
        words += fmt::format("{}{:.{}g}", words.empty() ? "(" : ", ", x, std::abs(x) < far ? 6 : 9);
    }
    return words + ")";
}

} // namespace slabhull
