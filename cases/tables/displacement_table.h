// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace slabhull {

/// Displacements of vertices at one time. Rows have tracks, positions at the start, or both.
template<int D>
struct DisplacementTable {
    std::string path;
    std::optional<double> time;    ///< where the file says it
    Array<TrackId> tracks;         ///< of each row, or none; no_track for rows that are not of the boundary
    Array<Point<D>> points;        ///< of each row, or none
    Array<Point<D>> displacements; ///< of each row
    std::function<std::string(std::size_t)> row_name; ///< "line 12", "point 5"
};

/// Reads a VTU (by its extension; point data `array` and perhaps `track_id`, field data `time` or
/// `TimeValue`), or else a CSV file (columns dx, dy, dz, and x, y, z or track_id or id, or both).
/// D = 2: z is passed over, a displacement along it must be zero and may be left out.
/// Throws InputError naming file, row and column or array.
template<int D>
DisplacementTable<D> read_displacement_table(const std::filesystem::path& path, const std::string& array);

} // namespace slabhull
