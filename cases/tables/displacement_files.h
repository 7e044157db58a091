// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/cases/displacement_match.h"
#include "slabhull/geometry/displacement_series.h"
#include "slabhull/topology/spatial_mesh.h"

#include "cases/tables/motion_tables.h"

#include <filesystem>
#include <span>

namespace slabhull {

template<int D>
struct DisplacementFiles {
    NodalMotionPointer<D> motion;
    DisplacementMatch match;
};

/// The motion of patches of one name by displacement files, one for each time. Every vertex of the patches
/// needs a row in every file: that of its track where the file has tracks, else the one at its place at the
/// start. Rows with both must also be at the vertex's place, at the start or displaced. Other rows are passed
/// over. `tracks` are those of the vertices of `start`.
///
/// Throws UsageError for a pattern that no file has, numbers of files and times that differ, and times that
/// do not ascend or do not cover `span`; InputError for a file that cannot be read, and naming file, vertex
/// and the distance of the nearest row where a vertex has no row or more than one, where two have the same,
/// and where vertices are displaced at the start already.
/// Holds 8 D bytes for each vertex of the patch and file. Cost: that of reading and sorting the files.
template<int D>
DisplacementFiles<D> read_displacement_files(const DisplacementSpec& spec, const Surface<D>& start,
                                             std::span<const TrackId> tracks,
                                             std::span<const PatchNumber> patches, const TimeInterval& span);

/// The files whose names are that of the pattern with a number instead of its '*', by ascending number.
/// Throws UsageError when there are none, or two with the same number.
std::vector<std::filesystem::path> files_of_pattern(const std::filesystem::path& pattern);

} // namespace slabhull
