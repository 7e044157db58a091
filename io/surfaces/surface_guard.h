// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <string>
#include <string_view>

namespace slabhull::io {

/// A surface file that OpenMesh can be trusted with. Its readers take a damaged number for zero, stumble over
/// comments, believe every count and know only single precision; so files are gone through before. What is
/// wrong is refused with an InputError that names the line (or byte) and the face; what is no geometry
/// (colours, names) is left out.
struct GuardedSurface {
    std::string text; ///< for OpenMesh
    bool binary = false;
    Array<Point<3>> points; ///< in double precision; empty for STL, where OpenMesh finds the points
    std::size_t faces = 0;  ///< triangles, at least one
};

GuardedSurface guard_stl(std::string_view bytes, const std::string& path);
GuardedSurface guard_off(std::string_view bytes, const std::string& path);
GuardedSurface guard_obj(std::string_view bytes, const std::string& path);
GuardedSurface guard_ply(std::string_view bytes, const std::string& path);

} // namespace slabhull::io
