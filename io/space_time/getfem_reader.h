// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/space_time_files.h"

#include <string>
#include <string_view>

namespace slabhull::io {

/// Whether these bytes start like a mesh that GetFEM or write_getfem() saved.
bool starts_like_getfem(std::string_view bytes);

/// Reads a GetFEM mesh of simplices GT_PK(3,1) or GT_PK(4,1). Points and convexes may have numbers with gaps,
/// in any order; they are numbered from 0 in the order of the file. Regions of faces are attributes; regions
/// of convexes, and sections other than meshes, are passed over. Throws InputError naming the line.
SpaceTimeSoup read_getfem(std::string_view bytes, const std::string& path);

} // namespace slabhull::io
