// SPDX-License-Identifier: BSD-3-Clause
// Columns over the cells and the points of a hull, as files and claims have them.
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/hull.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Neighbours: -1 where there is none.
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

/// A column of value(c) for each cell c, constant up to cell end_of(c) at least. Filling runs is many times
/// faster than cell by cell.
template<int D, class Value, class EndOf>
Column<std::int64_t> column_by_stretches(const Hull<D>& hull, const Value& value, const EndOf& end_of) {
    return {hull.cells.size(), 1, [value, end_of](std::size_t begin, std::size_t end, std::int64_t* out) {
                while (begin < end) {
                    const std::size_t stop = std::min(end, end_of(begin));
                    out = std::fill_n(out, stop - begin, static_cast<std::int64_t>(value(begin)));
                    begin = stop;
                }
            }};
}

// The hull must outlive these.

template<int D>
Column<std::int64_t> region_column(const Hull<D>& hull) {
    return column_by_stretches(
        hull, [&hull](std::size_t c) { return hull.region(c); },
        [&hull](std::size_t c) { return hull.region_end(c); });
}

template<int D>
Column<std::int64_t> patch_column(const Hull<D>& hull) {
    return column_by_stretches(
        hull, [&hull](std::size_t c) { return hull.patch(c); },
        [&hull](std::size_t c) { return hull.prism_end(c); });
}

template<int D>
Column<std::int64_t> layer_column(const Hull<D>& hull) {
    return column_by_stretches(
        hull, [&hull](std::size_t c) { return hull.layer(c); },
        [&hull](std::size_t c) { return hull.layer_end(c); });
}

} // namespace slabhull
