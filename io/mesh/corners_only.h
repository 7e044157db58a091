// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slabhull::io {

/// What follows "element 7 is a second-order line" where corners are not wanted.
inline constexpr const char* how_to_take_corners =
    "its corners are taken with initial.linear = true in a case, with --linear by convert";

/// Keeps account of the points that curved simplices have between their corners, for a reader that takes the
/// corners alone.
class CornersOnly {
public:
    /// A point that a curved simplex has, but not as a corner.
    void add_between(Index point, std::size_t points) {
        if (point >= between_.size()) {
            between_.resize(points, 0);
        }
        between_[point] = 1;
    }
    void add_cells(std::size_t count) { cells_ += count; }

    /// Leaves out the points that are no simplex's corner, with their data, and remarks on it. Points keep
    /// the file's numbers as their tags.
    void finish(Soup& soup) const;

private:
    std::vector<std::uint8_t> between_; ///< by point; shorter than the points
    std::size_t cells_ = 0;
};

} // namespace slabhull::io
