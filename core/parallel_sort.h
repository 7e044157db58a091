// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace slabhull {

/// Sorts by `<`, on all threads: pieces first, which are then merged in pairs. Needs: entries of which
/// neither is less than the other are equal, so that the result does not depend on threads.
template<class List>
void parallel_sort(List& list) {
    constexpr std::size_t worth_two_pieces = 1 << 15;
    const std::size_t most = std::max<std::size_t>(1, list.size() / worth_two_pieces);
    const std::size_t pieces = std::bit_floor(std::min(most, static_cast<std::size_t>(thread_count())));
    const auto place = [&](std::size_t piece) {
        return list.begin() + static_cast<std::ptrdiff_t>(list.size() * std::min(piece, pieces) / pieces);
    };
    parallel_for(pieces, 1,
                 [&](std::size_t piece, std::size_t) { std::sort(place(piece), place(piece + 1)); });
    for (std::size_t width = 1; width < pieces; width *= 2) {
        parallel_for(pieces / (2 * width), 1, [&](std::size_t pair, std::size_t) {
            const std::size_t first = 2 * width * pair;
            std::inplace_merge(place(first), place(first + width), place(first + 2 * width));
        });
    }
}

} // namespace slabhull
