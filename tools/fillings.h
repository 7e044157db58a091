// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/files_read.h"
#include "slabhull/io/soup.h"
#include "slabhull/io/space_time_files.h"

#include <optional>
#include <string>

namespace slabhull::tools {

/// Tells what is in a file that is a filling in space-time, see io::is_space_time_file(); false for others.
bool tell_filling(const std::string& file, bool json);

/// Tetrahedra of points (x, y, t), as a filling's. Throws InputError for other meshes.
io::SpaceTimeSoup filling_of_tetrahedra(const io::Soup& mesh);

struct FillingConversion {
    const std::string& in;
    const std::string& from; ///< the format of `in`; empty: that of its name
    const std::string& out;
    const std::string& to; ///< as `from`
    const io::FilesRead& read;
};

/// Whether converting has to do with fillings: from such a file, or to a format that only they have.
bool converts_filling(const std::string& in, const std::string& out, const std::string& to);
/// Writes the filling of a file in another of their formats, and tells what that does not hold. Tetrahedra of
/// points (x, y, t) may come from any format of meshes. Throws InputError for hulls and caps of slabs, which
/// are no fillings.
void convert_filling(const FillingConversion& conversion);

} // namespace slabhull::tools
