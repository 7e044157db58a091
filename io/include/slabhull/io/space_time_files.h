// SPDX-License-Identifier: BSD-3-Clause
// Files of space-time meshes: simplices of dimension 3 (2D + t) or 4 (3D + t), time last.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/column.h"
#include "slabhull/core/index.h"
#include "slabhull/io/atomic_file.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace slabhull::io {

/// A space-time mesh to be written, as columns, so that it is not copied.
struct SpaceTimeColumns {
    int dimension = 4;                    ///< of the simplices and of the points: 3 or 4
    Column<double> points;                ///< `dimension` components
    Column<std::int64_t> cells;           ///< dimension + 1 components, positively oriented
    Column<std::int64_t> neighbors;       ///< dimension + 1 components; -1 across the boundary
    Column<std::int64_t> facets;          ///< of the boundary: `dimension` components
    Column<std::int64_t> facet_attribute; ///< positive
    /// cell * (dimension + 1) + i for each facet: its cell, and the corner i opposite to it.
    Column<std::int64_t> facet_side;
    Column<std::int64_t> vertex_id;
    Column<std::int64_t> track_id;
    std::array<double, 2> time{};
    std::int64_t slab = 0;
};

/// The content of a file of a space-time mesh; missing arrays are empty.
struct SpaceTimeSoup {
    std::string path;
    int dimension = 0;
    Array<double> points;
    Array<Index> cells;
    Array<Index> facets;
    Array<std::int64_t> facet_attribute;
    Array<std::int64_t> neighbors;
    Array<std::int64_t> vertex_id;
    Array<std::int64_t> track_id;
    Array<double> time; ///< of the slab
};

/// MFEM's number for a pentatope differs by fork: 6 (CFOSLS and older), 7 (2021), 8 (later).
inline constexpr int usual_pentatope_code = 6;

/// MFEM mesh v1.0: elements of attribute 1, boundary elements with their facets' attributes. Dimension 4 is
/// read by forks of MFEM only. Throws LimitError for more than 2^31 - 1 of anything.
void write_mfem(AtomicFile& file, const SpaceTimeColumns& mesh, int pentatope_code = usual_pentatope_code);
/// GetFEM mesh: convexes GT_PK(dimension,1), a region of faces for each attribute.
void write_getfem(AtomicFile& file, const SpaceTimeColumns& mesh);
/// HDF5: the datasets /points, /cells, /neighbors, /facets, /facet_attribute, /vertex_id, /track_id, /time
/// and /slab, numbers from 0. Throws UsageError in a build without HDF5.
void write_h5(AtomicFile& file, const SpaceTimeColumns& mesh);

/// Whether a file starts like a space-time mesh: HDF5, GetFEM, or MFEM of dimension 4.
bool is_space_time_file(const std::filesystem::path& path);
/// Reads what write_h5() writes, GetFEM meshes, or MFEM mesh v1.0 of simplices of dimension 3 or 4 (with any
/// of the codes).
/// Every index is in range; else throws InputError naming the place.
SpaceTimeSoup read_space_time(const std::filesystem::path& path);

} // namespace slabhull::io
