// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <string>

namespace slabhull {

/// Numbers as messages list them: the first few, and "..." where there are more.
template<class Numbers>
std::string listed(const Numbers& numbers, std::size_t most = 8) {
    const auto shown = static_cast<std::ptrdiff_t>(std::min<std::size_t>(numbers.size(), most));
    return fmt::format("{}{}", fmt::join(numbers.begin(), numbers.begin() + shown, ", "),
                       numbers.size() > most ? ", ..." : "");
}

} // namespace slabhull
