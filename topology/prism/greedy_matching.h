// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

/// A nearly perfect matching of the dual graph of a surface; no_index for triangles left free.
/// Always takes a triangle with the fewest free neighbours and pairs it with its neighbour that has the
/// fewest: on a random cubic graph of n vertices this leaves about n^(1/5) free (Frieze, Radcliffe, Suen,
/// Combinatorics, Probability and Computing 4, 1995). Linear.
Array<Index> greedy_matching(std::span<const Neighbors<2>> neighbors);

} // namespace slabhull
