// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/io/csv_table.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace slabhull::io {

// All readers throw InputError naming the file, the place (line or byte) and the entity at fault. Memory
// stays within a small multiple of the file's size, whatever counts it claims. All writers write beside the
// final name and rename when complete and synced; they throw OutputError, and then whatever stood under the
// final name is untouched. Their memory does not grow with the mesh; the bytes do not depend on the number of
// threads.

/// MSH 2.2 and 4.1, ASCII and binary (little-endian). Points and straight lines, triangles and tetrahedra;
/// other elements, and partitioned meshes, are refused by name. Groups: those with a name and those in use.
/// An element of an entity in several groups gets the first; one that MSH 2.2 repeats for each of its groups
/// stays repeated. Data: `$NodeData` that give each node a value and `$ElementData` that give one to each
/// simplex of the top dimension become arrays of doubles; other sections are passed over.
Soup read_msh(const std::filesystem::path& path);
/// VTU of lines only, triangles only or tetrahedra only, in one piece, little-endian and uncompressed; arrays
/// inline or appended, ASCII, base64 or raw. Integers become int64, reals double, text arrays strings.
Soup read_vtu(const std::filesystem::path& path);
/// MSH or VTU by extension, or else by content.
Soup read_mesh(const std::filesystem::path& path);

/// A surface of triangles from STL, OFF, OBJ or PLY, by extension; faces as they come, however they meet.
/// Polygons are refused. Vertices of an STL, which has no other notion of connectivity, are in single
/// precision and welded where equal; facets that collapse by it are left out. The others keep double
/// precision and their numbering.
Soup read_surface(const std::filesystem::path& path);
/// The same, whatever the name: `extension` is ".stl", ".off", ".obj" or ".ply".
Soup read_surface_as(const std::filesystem::path& path, std::string_view extension);
/// A closed curve: a line "x y" per point, in order; a last point equal to the first is dropped; lines that
/// start with a letter (airfoil titles) or '#' are skipped. Lines of the soup have dimension 1.
Soup read_curve(const std::filesystem::path& path);

/// Numbers in columns with names. The first line that is not blank names them, perhaps behind a '#'; then a
/// line per row. Fields are parted by commas, or by semicolons or by blanks when the header has no commas;
/// names and numbers may stand in double quotes. Blank lines and lines that start with '#' are skipped. Every
/// field must be a finite number with a decimal point. At most 1000 columns.
CsvTable read_csv(const std::filesystem::path& path);
/// The same; but a file that starts like OpenFOAM's table of six degrees of freedom, the list of rows
/// (time ((x y z) (roll pitch yaw))) of its tabulated6DoFMotion, becomes a table with the columns time, x, y,
/// z, roll_deg, pitch_deg, yaw_deg.
CsvTable read_motion_table(const std::filesystem::path& path);

/// VTU, appended raw, UInt64 headers, little-endian; connectivity in 32 bits where it fits. Text arrays are
/// UInt8, each text ended by a zero byte (meshio opens no file with a string array of VTK's own kind);
/// read_vtu() gives them back.
void write_vtu(const std::filesystem::path& path, const MeshColumns& mesh);
/// MSH 4.1 binary: dense tags from 1, one block of nodes, one of elements per group (groups may share a
/// number, and then an entity), `$Entities` and `$PhysicalNames`; point data as `$NodeData`, cell data as
/// `$ElementData` (components > 1 become name_0, name_1 ..). Throws LimitError when data have more rows than
/// the format's 32 bits count, std::invalid_argument when the groups do not hold all cells in order.
void write_msh(const std::filesystem::path& path, const MeshColumns& mesh);
/// The same into a file that is the caller's to commit.
void write_vtu(AtomicFile& file, const MeshColumns& mesh);
void write_msh(AtomicFile& file, const MeshColumns& mesh);

/// A file of a series, and its time.
struct SeriesEntry {
    double time = 0;
    std::filesystem::path file; ///< taken from the folder of the .pvd where it is relative
};
/// A ParaView data file (.pvd): one data set for each entry, in order. Files of several kinds at one time
/// become parts: entries with the same time are numbered 0, 1 .. in their order. Throws UsageError for a time
/// that is not finite or a name with control characters, which XML cannot hold.
void write_pvd(const std::filesystem::path& path, std::span<const SeriesEntry> entries);

/// A small text file, in the same all-or-nothing way.
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace slabhull::io
