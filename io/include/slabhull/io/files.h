// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <filesystem>

namespace slabhull::io {

// All readers throw InputError naming the file, the place (line or byte) and the entity at fault. Memory stays within
// a small multiple of the file's size, whatever counts it claims.
// All writers write beside the final name and rename when complete and synced; they throw OutputError, and then
// whatever stood under the final name is untouched.

/// MSH 2.2 and 4.1, ASCII and binary. Simplices of order 1; other element types are refused by name.
Soup read_msh(const std::filesystem::path& path);
/// VTU with raw appended, inline ASCII or base64 data, uncompressed; triangles or tetrahedra.
Soup read_vtu(const std::filesystem::path& path);
/// MSH or VTU by extension.
Soup read_mesh(const std::filesystem::path& path);

/// A closed surface from STL, OFF, OBJ or PLY. Equal vertices of an STL, which has no other notion of
/// connectivity, are welded; the others come as they are. Polygons are refused.
Soup read_surface(const std::filesystem::path& path);
/// A closed curve: a line "x y" per point, in order; a last point equal to the first is dropped; lines that start with
/// a letter (airfoil titles) or '#' are skipped. Lines of the soup have dimension 1.
Soup read_curve(const std::filesystem::path& path);

/// VTU, appended raw, UInt64 headers, little endian.
void write_vtu(const std::filesystem::path& path, const MeshColumns& mesh);
/// MSH 4.1 binary: dense tags from 1, one block of nodes, one of elements per group, `$Entities` and
/// `$PhysicalNames`; point data as `$NodeData`, cell data as `$ElementData` (components > 1 become name_0, name_1 ..).
void write_msh(const std::filesystem::path& path, const MeshColumns& mesh);
/// A small text file, in the same all-or-nothing way.
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace slabhull::io
