// SPDX-License-Identifier: BSD-3-Clause
// Integers of a mesh in few bytes. A browser takes longer for each byte of a page than a script for
// unpacking.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Bytes of a page.
using Packed = Array<std::uint8_t>;

/// Seven bits a byte, the lowest first; all bytes of a number but the last have the eighth bit.
void append_number(Packed& packed, std::uint64_t number);

/// A number d that may be negative, as 2d, or then as -2d - 1.
void append_difference(Packed& packed, std::int64_t d);

/// Differences of consecutive integers, of the first to 0.
Packed pack_differences(std::span<const std::int64_t> values);

/// Pairs of numbers: a value that is not negative, and how often it follows.
Packed pack_runs(std::span<const std::int64_t> values);

/// Vertices of cells. A cell shares most with those shortly before. `codes` has four bits for each vertex,
/// the lower half of a byte first: k < 15 for the one that was k-th last in `far`, 15 for the next in `far`.
/// There it is the difference from it to one more than the largest in `far` so far: 0 where numbers follow
/// first use.
struct PackedCells {
    Packed codes;
    Packed far;
};
PackedCells pack_cells(std::span<const Index> vertices);

} // namespace slabhull
