// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/integer_list.h"

#include <cstddef>
#include <span>
#include <utility>

namespace slabhull {

/// Keeps the given rows of `width` values, in the order given. An empty list stays empty: it was not given.
template<class Values>
void keep_rows(Values& values, std::span<const Index> rows, std::size_t width = 1) {
    if (values.empty()) {
        return;
    }
    Values kept;
    kept.reserve(rows.size() * width);
    for (const Index row : rows) {
        for (std::size_t k = 0; k < width; ++k) {
            kept.push_back(values[row * width + k]);
        }
    }
    values = std::move(kept);
}

inline void keep_rows(IntegerList& values, std::span<const Index> rows, std::size_t width = 1) {
    if (!values.empty()) {
        values = IntegerList::generated(
            rows.size() * width, [&](std::size_t i) { return values[rows[i / width] * width + i % width]; });
    }
}

} // namespace slabhull
