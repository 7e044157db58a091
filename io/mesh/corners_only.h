// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slabhull::io {

/// Continues "element 7 is a second-order line" if ReadOptions::linear is not set.
inline constexpr const char* how_to_take_corners =
    "its corners are taken with initial.linear = true in a case, with --linear by convert";

/// Records the points between the corners of curved simplices, for a reader that keeps only corners.
class CornersOnly {
public:
    /// Records a point of a curved simplex that is not a corner of it.
    void add_between(Index point, std::size_t points) {
        if (point >= between_.size()) {
            between_.resize(points, 0);
        }
        between_[point] = 1;
    }
    void add_cells(std::size_t count) { cells_ += count; }

    /// Removes recorded points that are not a corner of any simplex, with their data, and adds a remark.
    /// Points keep the file's numbers as tags.
    void finish(Soup& soup) const;

private:
    std::vector<std::uint8_t> between_; ///< by point; may be shorter than the points
    std::size_t cells_ = 0;
};

} // namespace slabhull::io
