// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Neighbours as files and claims have them: -1 where there is none.
template<std::size_t N>
Column<std::int64_t> neighbor_column(std::span<const std::array<Index, N>> neighbors) {
    return {neighbors.size(), static_cast<int>(N),
            [neighbors](std::size_t begin, std::size_t end, std::int64_t* out) {
                for (std::size_t c = begin; c < end; ++c) {
                    for (const Index neighbor : neighbors[c]) {
                        *out++ = neighbor == no_index ? -1 : std::int64_t{neighbor};
                    }
                }
            }};
}

} // namespace slabhull
