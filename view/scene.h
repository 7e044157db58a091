// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/patch.h"
#include "slabhull/geometry/measures.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace slabhull {

/// A range of cells in the order of the page.
struct CellRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// A slab of the page: its name, its times, and its cells among those of the scene.
struct SceneSlab {
    std::string name;
    double first = 0;
    double last = 0;
    CellRange side;
    CellRange inside;
};

/// What a page is drawn from, all slabs one after the other. Vertices are numbered in the order in which the
/// cells use them; those of one slab are not those of the next.
struct Scene {
    int dimension = 0; ///< of space
    bool filled = false;
    std::vector<double> centre; ///< that places are relative to
    double tolerance = 0;       ///< times closer than this count as equal

    Array<float> points;             ///< of vertices, `dimension` each
    Array<double> times;             ///< of vertices
    Array<std::int64_t> ids, tracks; ///< of vertices, -1 for none

    Array<Index> side; ///< dimension + 1 vertices a cell, oriented outward, by ascending first time
    Array<PatchNumber> side_patch; ///< of each side cell
    Array<Index> inside;           ///< cells of caps, or where `filled`, simplices of dimension + 1

    PatchList patches;
    std::vector<SceneSlab> slabs;
    AngleHistogram angles{};

    int inside_corners() const { return dimension + (filled ? 2 : 1); }
};

} // namespace slabhull
