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

/// Which of a hull's cells columns are of: `count` from `first` on.
struct HullRange {
    std::size_t first = 0;
    std::size_t count = 0;

    std::size_t end() const { return first + count; }
    bool contains(std::size_t cell) const { return cell - first < count; }
};

/// A column of value(c) for each cell c of a range, constant up to cell end_of(c) at least. Filling runs is
/// many times faster than cell by cell.
template<class Value, class EndOf>
Column<std::int64_t> column_by_stretches(const HullRange& cells, const Value& value, const EndOf& end_of) {
    return {cells.count, 1,
            [value, end_of, first = cells.first](std::size_t begin, std::size_t end, std::int64_t* out) {
                for (std::size_t c = first + begin; c < first + end;) {
                    const std::size_t stop = std::min(first + end, end_of(c));
                    out = std::fill_n(out, stop - c, static_cast<std::int64_t>(value(c)));
                    c = stop;
                }
            }};
}

// The hull, or its order, must outlive these. Without a range they are of all cells.

template<int D>
Column<std::int64_t> region_column(const HullOrder<D>& hull, const HullRange& cells) {
    return column_by_stretches(
        cells, [&hull](std::size_t c) { return hull.region(c); },
        [&hull](std::size_t c) { return hull.region_end(c); });
}
template<int D>
Column<std::int64_t> region_column(const Hull<D>& hull) {
    return region_column<D>(hull, {0, hull.cells.size()});
}

template<int D>
Column<std::int64_t> patch_column(const HullOrder<D>& hull, const HullRange& cells) {
    return column_by_stretches(
        cells, [&hull](std::size_t c) { return hull.patch(c); },
        [&hull](std::size_t c) { return hull.prism_end(c); });
}
template<int D>
Column<std::int64_t> patch_column(const Hull<D>& hull) {
    return patch_column<D>(hull, {0, hull.cells.size()});
}

template<int D>
Column<std::int64_t> layer_column(const HullOrder<D>& hull, const HullRange& cells) {
    return column_by_stretches(
        cells, [&hull](std::size_t c) { return hull.layer(c); },
        [&hull](std::size_t c) { return hull.layer_end(c); });
}
template<int D>
Column<std::int64_t> layer_column(const Hull<D>& hull) {
    return layer_column<D>(hull, {0, hull.cells.size()});
}

} // namespace slabhull
