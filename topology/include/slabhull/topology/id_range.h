// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <cstddef>
#include <ranges>

namespace slabhull {

/// The ids 0 .. count - 1 of one kind, as a random-access range.
template<class IdType>
auto id_range(std::size_t count) {
    return std::views::iota(Index{0}, static_cast<Index>(count)) |
           std::views::transform([](Index slot) { return IdType{slot}; });
}

} // namespace slabhull
