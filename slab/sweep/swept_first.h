// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Numbers of a cap's vertices with the swept ones first; the others keep their order.
inline std::vector<Index> swept_first(std::size_t vertices, std::span<const Index> cap_vertex) {
    std::vector<Index> number(vertices, no_index);
    for (std::size_t v = 0; v < cap_vertex.size(); ++v) {
        number[cap_vertex[v]] = static_cast<Index>(v);
    }
    auto next = static_cast<Index>(cap_vertex.size());
    for (Index& n : number) {
        n = n == no_index ? next++ : n;
    }
    return number;
}

} // namespace slabhull
