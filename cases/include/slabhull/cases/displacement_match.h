// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

namespace slabhull {

/// How the vertices of a patch were found in its files of displacements.
struct DisplacementMatch {
    std::size_t files = 0;
    std::size_t vertices = 0;    ///< of the patch
    double tolerance = 0;        ///< distance allowed
    double largest = 0;          ///< distance between a vertex and its row
    std::filesystem::path where; ///< the file of that row; empty when all distances are zero
};

} // namespace slabhull
