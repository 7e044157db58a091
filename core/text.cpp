// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/text.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace slabhull {

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

} // namespace slabhull
