// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/corners_only.h"

#include "core/rows.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace slabhull::io {

namespace {

void renumber(Soup& soup, const Array<Index>& number) {
    if (soup.point_tags.empty()) {
        soup.point_tags.resize(soup.points.size());
        std::iota(soup.point_tags.begin(), soup.point_tags.end(), std::int64_t{0});
    }
    Array<Index> kept;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] != no_index) {
            kept.push_back(static_cast<Index>(v));
        }
    }
    keep_rows(soup.points, kept);
    keep_rows(soup.point_tags, kept);
    for (DataArray& array : soup.point_data) {
        array.keep_rows(kept);
    }
    for (SimplexBlock& block : soup.simplices) {
        std::transform(block.vertices.begin(), block.vertices.end(), block.vertices.begin(),
                       [&](Index vertex) { return number[vertex]; });
    }
}

} // namespace

void CornersOnly::finish(Soup& soup) const {
    if (cells_ == 0) {
        return;
    }
    Array<Index> number(soup.points.size());
    std::fill(number.begin(), number.end(), Index{0});
    for (std::size_t v = 0; v < between_.size(); ++v) {
        number[v] = between_[v] != 0 ? no_index : 0;
    }
    for (const SimplexBlock& block : soup.simplices) { // may be a corner of another simplex
        for (const Index vertex : block.vertices) {
            number[vertex] = 0;
        }
    }
    Index next = 0;
    for (Index& each : number) {
        each = each == no_index ? no_index : next++;
    }
    soup.remarks.push_back(
        fmt::format("{}: {} curved elements: their corners are taken, {} points between them "
                    "left out",
                    soup.path, cells_, soup.points.size() - next));
    renumber(soup, number);
}

} // namespace slabhull::io
