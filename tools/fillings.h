// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"
#include "slabhull/io/space_time_files.h"

#include <optional>
#include <string>

namespace slabhull::tools {

/// Tells what is in a file that is a filling in space-time, see io::is_space_time_file(); false for others.
bool tell_filling(const std::string& file, bool json);

/// Tetrahedra of points (x, y, t), as a filling's. Throws InputError for other meshes.
io::SpaceTimeSoup filling_of_tetrahedra(const io::Soup& mesh);

/// Whether converting has to do with fillings: from such a file, or to a format that only they have.
bool converts_filling(const std::string& in, const std::string& out, const std::string& to);
/// Writes the filling of a file in another of their formats. Tetrahedra of points (x, y, t) may come from any
/// format of meshes.
void convert_filling(const std::string& in, const std::string& from, const std::string& out,
                     const std::string& to);

} // namespace slabhull::tools
