// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/patch.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/io/soup.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace slabhull {

/// What `slabhull info` tells of a mesh file; nothing is checked.
struct SoupInfo {
    struct Bounds {
        char axis; ///< 'x', 'y', 'z' or 't'
        double smallest, largest;
    };
    struct Region {
        std::string name;
        std::size_t cells = 0;
        double measure = 0;
    };
    /// The simplices of a physical group or, at the top dimension, of a patch.
    struct Group {
        int dimension = 0;
        Patch patch;
        std::size_t cells = 0;
        double measure = 0;
    };

    int dimension = 0; ///< of the cells
    bool hull = false; ///< triangles in (x, y, t), or tetrahedra with a point array "t"
    std::size_t points = 0;
    std::array<std::size_t, 4> simplices{}; ///< by dimension
    std::vector<Bounds> bounds;             ///< empty when there are no points
    std::vector<Region> regions;            ///< of a hull that tells them: initial, side, terminating
    std::vector<Group> groups;              ///< by descending dimension, then as the file lists them
    double measure = 0;                     ///< of all cells, each counted positive
    AngleHistogram angles{};                ///< of cells of dimension 2 and 3
    AngleRange angle{180, 0};
};

/// Takes the soup by value: it first brings the numbers to the form that all formats share.
/// Throws InputError like settle_numbers(). Cost: linear.
SoupInfo soup_info(io::Soup soup);

} // namespace slabhull
