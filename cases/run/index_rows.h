// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/core/index.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Rows of indices, such as cells, as files have them; `shift` is added to each.
template<std::size_t N>
Column<std::int64_t> index_rows(std::span<const std::array<Index, N>> rows, std::int64_t shift = 0) {
    return {rows.size(), N, [rows, shift](std::size_t begin, std::size_t end, std::int64_t* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    for (const Index value : rows[row]) {
                        *out++ = static_cast<std::int64_t>(value) + shift;
                    }
                }
            }};
}

} // namespace slabhull
