// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/text.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>
#include <vector>

namespace slabhull {

namespace {

/// Levenshtein's distance of the names in small letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (small(a[i - 1]) == small(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string readable(std::string_view text) {
    constexpr std::size_t shown = 300; // of either end
    std::string result{text};
    if (text.size() > 2 * shown) {
        result = fmt::format("{} ... {}", text.substr(0, shown), text.substr(text.size() - shown));
    }
    std::replace_if(
        result.begin(), result.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
    return result;
}

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    constexpr std::size_t longest = 200; // beyond, it is no name
    std::string nearest;
    std::size_t best = name.size() > longest ? 0 : longest;
    for (const std::string& each : known) {
        const std::size_t letters = std::max(name.size(), each.size());
        const std::size_t distance = letters > longest ? longest : edit_distance(name, each);
        if (distance < best && distance <= (letters + 1) / 3) { // a third of the letters, rounded
            best = distance;
            nearest = each;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> known) {
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", readable(nearest));
}

} // namespace slabhull
