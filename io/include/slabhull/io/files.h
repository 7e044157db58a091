// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/csv_table.h"
#include "slabhull/io/piece.h"
#include "slabhull/io/read_options.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

// All readers throw InputError naming the file, the place (line or byte) and the entity at fault. Memory
// stays within a small multiple of the file's size, whatever counts it claims; packed arrays take the size
// that the XML claims, at most 1032 times their size in the file with zlib and 255 times with LZ4. All
// writers write to a temporary file, synced and renamed when complete; if they throw OutputError, an existing
// file is untouched. Their memory does not grow with the mesh; the bytes do not depend on the number of
// threads.

/// Thrown for a format that this build was configured without. Legacy VTK, XDMF, TetGen, Medit, MFEM and avro
/// can be left out (SLABHULL_FORMATS); their readers and writers then throw this.
class FormatLeftOut : public UsageError {
public:
    using UsageError::UsageError;
};

/// MSH 2.2 and 4.1, ASCII and binary, in either byte order. Points and straight lines, triangles and
/// tetrahedra; other elements are refused by name (curved simplices unless ReadOptions::linear). Parameters
/// of nodes are ignored, and so are partitions: a partitioned mesh gives each element of the model once, with
/// the model's entities. Groups: those with a name and those in use. An element whose entity is in several
/// groups gets the first, with a remark; one that MSH 2.2 repeats for each of its groups stays repeated.
/// Data: `$NodeData` that give each node a value and `$ElementData` that give one to each simplex of the top
/// dimension become arrays of doubles; other sections are ignored.
Soup read_msh(const std::filesystem::path& path);
/// VTU of vertices, lines, triangles and tetrahedra, in either byte order; arrays inline or appended, ASCII,
/// base64 or raw, as they are or packed by zlib or LZ4. If cells have several dimensions, each keeps its
/// number in the file as its tag, cell data are those of the largest dimension, and an array of integers
/// gives the groups (ReadOptions::patch_array). Pieces, which must have the same arrays, are concatenated;
/// points that they share stay separate. Integers become int64, reals double, text arrays strings.
Soup read_vtu(const std::filesystem::path& path);
/// A .pvtu and the .vtu files that it names, joined. If there is a point array "GlobalPointIds", points with
/// equal numbers are merged; points and cells are sorted by their global numbers, if any, else in the order
/// of the files. Copies of other pieces' cells (with a repeated "GlobalCellIds", or marked in "vtkGhostType")
/// are left out, and so are arrays of global numbers that only count.
Soup read_pvtu(const std::filesystem::path& path);
/// VTK legacy (.vtk), versions 1 to 5.1, ASCII and binary: an unstructured grid of vertices, lines, triangles
/// and tetrahedra, mixed or not, or POLYDATA of vertices, lines of two points and triangles. Mixed cells are
/// read as by read_vtu(). Arrays as in read_vtu(); colours are skipped, bit arrays refused. `vtkIdType` is
/// taken as 32 bits, as VTK writes it, `long` as 64.
Soup read_vtk(const std::filesystem::path& path);
/// TetGen's files, which share a stem; numbers from 0 or 1, comments anywhere. A .node or .ele: the points
/// and those of .ele, .neigh and .face that exist beside it; a .face: the points and the triangles. A .poly
/// or .smesh: the points, in it or in a .node, and facets of triangles without holes. Triangle's planar .node
/// and .ele are read, too. A triangle's positive marker is its group. Data: attributes and "marker" of
/// points, attributes or "marker" of cells, "neighbors" from 0 (checked, -1 for none), "holes" (3 components)
/// and "regions" (5) of the field. Attributes are doubles called attribute_0 .., or as write_tetgen() names
/// them.
Soup read_tetgen(const std::filesystem::path& path);
/// XDMF (.xdmf, .xmf), versions 2 and 3: one uniform grid of Polyvertex, Polyline of two points, Triangle,
/// Tetrahedron or Mixed cells (of which each simplex keeps its number as its tag, and cell data those of the
/// largest dimension), Geometry XYZ or XY, plain DataItems as text, in binary files or in HDF5, there packed
/// by deflate or not. Attributes of the grid and the Information that write_xdmf() writes are field data.
/// Claimed sizes of datasets are checked against the HDF5 file's size. Throws UsageError for HDF5 in a build
/// without it.
Soup read_xdmf(const std::filesystem::path& path);
/// Whether this build has HDF5.
bool has_hdf5();
/// A file of any format of io/formats.h, by extension or else by content.
Soup read_mesh(const std::filesystem::path& path);
Soup read_mesh(const std::filesystem::path& path, const ReadOptions& options);

/// Medit .mesh, ASCII, of 2, 3 or 4 dimensions: vertices, edges, triangles, tetrahedra. References become
/// groups without names; those of vertices, where one is not 0, the point data `medit:ref`. A fourth
/// coordinate becomes the point data `t`. Sections about the look of edges and surfaces (corners, ridges,
/// normals) are ignored; other elements, negative references and a file without `End` are refused.
Soup read_medit(const std::filesystem::path& path);
/// The mesh of the adaptation library avro (.avro): a JSON object with the keys `dim` (2, 3 or 4), `number`
/// (the simplices' dimension), `type` ("simplex"), `vertices` (all coordinates) and `elements` (all vertices'
/// numbers, from 0), and optionally `nb_ghost` (0). A fourth coordinate becomes the point data `t`; other
/// keys are ignored.
Soup read_avro(const std::filesystem::path& path);
/// MFEM mesh v1.0 without curves: segments, triangles or tetrahedra, and their boundary elements. Attributes
/// become groups without names.
Soup read_mfem(const std::filesystem::path& path);

/// A surface from STL, OFF, OBJ or PLY, by extension; faces are not checked for how they meet. Planar
/// polygons (to rounding) are cut into triangles, with a remark and, as tags, the file's numbers of the faces
/// from 0; others are refused. Groups: the solids of an STL; the groups (`g`), objects (`o`) or materials
/// (`usemtl`) of an OBJ, the first kind with several names or else with one; the values of a PLY's
/// whole-numbered face property `patch`, `group`, `region`, `zone`, `part` or `material_index`. Vertices of
/// an STL, which stores no connectivity, are in single precision and welded if equal; facets that collapse
/// are left out, with a remark. The other formats keep double precision and their numbering.
Soup read_surface(const std::filesystem::path& path);
/// The same with the format given: `extension` is ".stl", ".off", ".obj" or ".ply".
Soup read_surface_as(const std::filesystem::path& path, std::string_view extension);
/// A closed curve: a line "x y" per point, in order; a last point equal to the first is dropped; lines that
/// start with a letter (airfoil titles) or '#' are skipped. An airfoil in Lednicer's order (a line with two
/// counts, then the upper and the lower side, both from the leading edge on) becomes one curve, with a
/// remark. Lines of the soup have dimension 1.
Soup read_curve(const std::filesystem::path& path);

/// Numbers in named columns. The first line that is not blank has the names, optionally after a '#'; then
/// each line is a row. Fields are separated by commas or, if the header has none, by semicolons or blanks;
/// names and numbers may be in double quotes. Blank lines and lines that start with '#' are skipped. Every
/// field must be a finite number with a decimal point. At most 1000 columns.
CsvTable read_csv(const std::filesystem::path& path);
/// The same; but a file that starts like OpenFOAM's table of six degrees of freedom, the list of rows
/// (time ((x y z) (roll pitch yaw))) of its tabulated6DoFMotion, becomes a table with the columns time, x, y,
/// z, roll_deg, pitch_deg, yaw_deg.
CsvTable read_motion_table(const std::filesystem::path& path);

/// How the arrays of a VTU file are stored: appended raw, or packed by zlib (level 5) or LZ4 in blocks of 256
/// KiB; or as text with the fewest digits that read back exactly. Packed arrays are buffered in an unnamed
/// file in the same folder. VTK reads all, meshio all but LZ4.
enum class VtuEncoding { raw, zlib, lz4, ascii };
/// VTU, UInt64 headers, little-endian; connectivity in 32 bits where it fits. Text arrays are UInt8, each
/// text ended by a zero byte (meshio opens no file with a string array of VTK's own kind); read_vtu()
/// restores them.
void write_vtu(const std::filesystem::path& path, const MeshColumns& mesh,
               VtuEncoding encoding = VtuEncoding::raw);
/// The mesh in pieces for readers that work in parallel: NAME.pvtu names NAME_0.vtu .. beside it, which hold
/// ranges of cells of nearly equal length, in order, and the points that these use (the last one also those
/// that none uses). "GlobalPointIds" and "GlobalCellIds" are the numbers in the whole mesh; all other data
/// are unchanged. The .pvtu gets its name last. Throws UsageError unless each piece gets a cell, FormatLimit
/// for data with these names. Memory:
/// besides that of write_vtu(), three bits per point.
void write_pvtu(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                std::size_t pieces, VtuEncoding encoding = VtuEncoding::raw);
/// The file of one piece of such a mesh, the bytes that write_pvtu() gives it; with piece 0 also the .pvtu,
/// as the last file opened, which should get its name last.
void write_pvtu_piece(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& piece,
                      VtuEncoding encoding = VtuEncoding::raw);
enum class MshVersion { v4_1, v2_2 };
struct MshOptions {
    MshVersion version = MshVersion::v4_1;
    bool ascii = false; ///< text with the fewest digits that read back exactly; else binary
};
/// MSH: dense tags from 1, one block of nodes, one of elements per group (groups may share a number, and then
/// an entity), `$PhysicalNames` and, in version 4.1, `$Entities`; point data as `$NodeData`, cell data as
/// `$ElementData`. Reals of 3 or 9 components are one array, all others become name_0, name_1 ... Throws
/// FormatLimit for counts beyond the format's, which are 32 bits except for nodes and elements of version
/// 4.1, and for names with a double quote or a line end; std::invalid_argument if the groups do not contain
/// all cells in order.
void write_msh(const std::filesystem::path& path, const MeshColumns& mesh, const MshOptions& options = {});
/// The mesh in pieces for readers that work in parallel, as Gmsh splits a partitioned mesh: for NAME.msh the
/// files NAME_1.msh .., each the part of one partition, binary 4.1. Pieces are those of write_pvtu(); a lower
/// simplex is in the first piece that has its points. Numbers of nodes and elements are those in the whole
/// mesh; Gmsh joins files that are opened one after the other. Throws as write_msh() and write_pvtu() do, and
/// UsageError for other options than the default ones.
void write_msh_pieces(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                      std::size_t pieces, const MshOptions& options = {});
/// The file of one piece of such a mesh, the bytes that write_msh_pieces() gives it.
void write_msh_piece(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& piece,
                     const MshOptions& options);
/// The same into a file that the caller commits.
void write_vtu(AtomicFile& file, const MeshColumns& mesh, VtuEncoding encoding = VtuEncoding::raw);
void write_msh(AtomicFile& file, const MeshColumns& mesh, const MshOptions& options = {});
/// VTK legacy, version 4.2, binary: the content of write_vtu(), arrays as FIELD, int64 as `long` (the only
/// name that both VTK, where a long has 64 bits, and meshio read), text arrays as bytes whose component is
/// called slabhull_text. Throws FormatLimit if the points or the values of CELLS exceed 32 bits.
void write_vtk(AtomicFile& file, const MeshColumns& mesh);

/// XDMF 3 for NAME.xdmf, and the data in NAME.h5 beside it, which gets its name just before; plain, in
/// datasets /points, /cells, /point_data/.., /cell_data/.., /field_data/... Field data are Information, which
/// other readers ignore. Tetrahedra with real point data `t` have x, y, z, t side by side in /xyzt, too. HDF5
/// must not be used by other threads meanwhile. Throws UsageError when the file itself is called NAME.h5 and
/// in a build without HDF5.
void write_xdmf(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh);
void write_xdmf(const std::filesystem::path& path, const MeshColumns& mesh);

/// TetGen's files, numbered from 0, stem.node and: of tetrahedra stem.ele, with cell data "neighbors" of 4
/// components stem.neigh, with triangles beside them (MeshColumns::lower) stem.face; of triangles stem.face
/// and stem.smesh or, where `path` is called so, stem.poly. The stem is `path` without TetGen's extensions.
/// Data become attributes, with names and types in a comment that read_tetgen() understands; point data
/// "marker", one integer, become the points' markers. Groups of tetrahedra become an attribute that
/// read_tetgen() turns into groups again. A triangle's marker is its "marker", else "patch", else group; its
/// other data are left out. Throws FormatLimit for lines and if the extension of `path` does not fit the
/// cells, OutputError if an .ele, .neigh or .face of another mesh has the stem.
void write_tetgen(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh);
/// The same for a stem, with .smesh.
void write_tetgen(const std::filesystem::path& stem, const MeshColumns& mesh);

struct MeditOptions {
    /// Our dialect for hulls in 3D + t: `Dimension 4` and vertices x y z t, t taken from the point data `t`.
    /// Programs for Medit's own 2 and 3 dimensions do not read it.
    bool four_dimensional = false;
};
/// Medit .mesh, ASCII, version 2 (4 where a count needs 64 bits), with lower simplices down to lines.
/// References: the numbers of the groups, and the point data `medit:ref` (integers) or 0. Doubles read back
/// exactly; names and other data are left out. Throws UsageError for the dialect without real point data `t`.
void write_medit(AtomicFile& file, const MeshColumns& mesh, const MeditOptions& options = {});
void write_medit(const std::filesystem::path& path, const MeshColumns& mesh,
                 const MeditOptions& options = {});

/// The same layout. Tetrahedra with real point data `t` have vertices x, y, z, t, all others x, y, z. Doubles
/// read back exactly; groups and other data are left out.
void write_avro(AtomicFile& file, const MeshColumns& mesh);
void write_avro(const std::filesystem::path& path, const MeshColumns& mesh);

/// MFEM mesh v1.0. Attributes of elements are the groups' numbers, those of cells without a group the number
/// after the largest. The boundary elements are the facets of one cell only, oriented as its boundary, with
/// attribute 1; to find them the cells are copied: with their adjacency 8 (D + 1) bytes per cell. Points have
/// two coordinates if all third ones of lines or triangles are 0. Doubles read back exactly; names and data,
/// the times of hulls in 3D + t among them, are left out. Throws FormatLimit beyond 2^31 - 1 vertices or
/// cells, GeometryError for a cell that has a vertex twice.
void write_mfem(AtomicFile& file, const MeshColumns& mesh);
void write_mfem(const std::filesystem::path& path, const MeshColumns& mesh);

/// Surfaces of triangles: STL (binary; coordinates in single precision, vertices repeated by facet), OFF and
/// OBJ (text, doubles that read back exactly), PLY (binary, doubles). Groups and data are left out. Throws
/// FormatLimit for a mesh of other simplices and if counts or, in STL, coordinates are too large.
void write_stl(AtomicFile& file, const MeshColumns& mesh);
void write_off(AtomicFile& file, const MeshColumns& mesh);
void write_obj(AtomicFile& file, const MeshColumns& mesh);
void write_ply(AtomicFile& file, const MeshColumns& mesh);
/// One of these, by extension.
void write_surface(const std::filesystem::path& path, const MeshColumns& mesh);

/// A file of a series, and its time.
struct SeriesEntry {
    double time = 0;
    std::filesystem::path file; ///< a relative path is taken from the .pvd's folder
};
/// A ParaView data file (.pvd): one data set for each entry, in order. Files of several kinds at one time
/// become parts: entries with the same time are numbered 0, 1 .. in their order. Throws UsageError for a time
/// that is not finite or a name with control characters, which XML cannot hold.
void write_pvd(const std::filesystem::path& path, std::span<const SeriesEntry> entries);
/// The data sets of a .pvd in their order, each with the .pvd's folder in front of a relative path.
std::vector<SeriesEntry> read_pvd(const std::filesystem::path& path);

/// Writes a small text file, also complete or not at all.
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace slabhull::io
