// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Enlarges a matching of the dual graph of a surface along alternating paths between free triangles, found
/// by breadth-first search from all of them at once. Odd cycles are not contracted, so paths may be missed.
class AlternatingForest {
public:
    AlternatingForest(std::span<const Neighbors<2>> neighbors, std::span<Index> mate);

    /// One search: augments along disjoint paths, at most one for each tree. Linear. Returns how many there
    /// were.
    std::size_t augment();

private:
    enum class Label : std::uint8_t { unreached, odd, even }; ///< by the distance from the root

    void plant();
    bool extend(Index even);
    void reach(Index odd, Index from);
    void join(Index even, Index other);
    void release(Index even);

    std::span<const Neighbors<2>> neighbors_;
    std::span<Index> mate_;
    Array<Label> label_;
    Array<Index> root_;
    Array<Index> parent_;         ///< of an even triangle: the one two steps nearer to the root
    std::vector<Index> even_;     ///< in the order reached
    std::vector<bool> root_done_; ///< its tree has given a path
};

} // namespace slabhull
