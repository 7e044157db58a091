// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/communicator.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/formats.h"
#include "slabhull/io/soup.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/slab/slice.h"
#include "slabhull/slab/slice_filling.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/spatial_mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace slabhull {

/// Writes a hull in `format`, "vtu", "pvtu" or "msh", with the arrays of docs/formats.md. Streams: no second
/// copy is made. The files, several where options.pieces are, are the caller's to commit. Throws OutputError,
/// and UsageError for more pieces than the hull has cells.
template<int D>
void write_hull(io::AtomicFiles& files, const std::filesystem::path& path, const Hull<D>& hull,
                const std::string& format, const io::WriteOptions& options = {});

/// A part of a hull, and what its files say of the whole.
template<int D>
struct PartToWrite {
    const HullPart<D>& part;
    const HullOrder<D>& order;
    std::size_t number = 0;
    std::size_t parts = 1;
    Array<std::int64_t> first_cells; ///< of the whole hull, that use each point of the part
    std::array<Point<3>, 2> box{};   ///< around all points, as files have them
};

/// What parts have to know of each other before they are written: see PartToWrite. Collective. Cost: linear
/// in the part; it sends each point's number to one other rank.
template<int D>
PartToWrite<D> part_to_write(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks);

/// Writes a part of a hull in `format`, "pvtu" or "msh": the files, and the bytes, that write_hull() gives
/// that part in as many pieces; the first rank's files end with the .pvtu. Throws as write_hull() does.
template<int D>
void write_part(io::AtomicFiles& files, const std::filesystem::path& path, const PartToWrite<D>& part,
                const std::string& format, const io::WriteOptions& options);

/// Writes a cap as a spatial mesh with ids and tracks, as VTU.
template<int D>
void write_cap(io::AtomicFile& file, const SpatialMesh<D>& cap, double time);

/// The same of a hull's terminating cap, without a copy of it.
template<int D>
void write_terminating_cap(io::AtomicFile& file, const Hull<D>& hull);

/// Reads a cap that write_cap() wrote: points, cells, ids and tracks bit for bit, adjacency made anew.
/// Boundary facets and patches are not in the file. Throws InputError.
template<int D>
SpatialMesh<D> read_cap(const std::filesystem::path& path);

/// Writes a section as VTU: lines (D = 2) or triangles (D = 3) in space, with the arrays of docs/formats.md.
template<int D>
void write_section(io::AtomicFile& file, const Section<D>& section);

/// What a solver found at a filling's vertices.
struct VertexValues {
    std::string name;
    std::span<const double> values;
};

/// Writes a filling's section as VTU: triangles (D = 2) or tetrahedra (D = 3) in space, with the arrays of
/// docs/formats.md, and `solution`, cut with the mesh, as point data.
template<int D>
void write_section(io::AtomicFile& file, const FillingSection<D>& section,
                   std::span<const VertexValues> solution = {});

/// What kind of mesh a file holds.
struct MeshKind {
    int dimension; ///< of its simplices
    bool hull;     ///< a hull in space-time; otherwise a mesh in space
};

/// A hull has a point array "t" or, in an MSH of triangles, regions among its physical groups.
/// Throws InputError when the soup has neither triangles nor tetrahedra.
MeshKind kind_of(const io::Soup& soup);

/// A hull as a file has it: the arrays that are in it, empty where they are not.
template<int D>
struct HullArrays {
    Array<Point<D + 1>> points;
    Array<Index> vertices;                           ///< of cells, D + 1 of each
    IntegerList region, patch, layer;                ///< of cells
    IntegerList neighbors;                           ///< of cells, D + 1 of each
    IntegerList vertex_id, track_id, cell_of_vertex; ///< of points
    PatchList patches;
    std::optional<std::array<double, 2>> time;

    HullColumns<D> columns() const;
};

/// Takes the arrays of a hull out of what a file says; throws InputError for arrays of the wrong shape. The
/// soup loses its points, cells and their data, array by array, so that nothing is held twice; it keeps its
/// tags, groups and field data.
template<int D>
HullArrays<D> hull_of_soup(io::Soup& soup);

/// Takes the number of the slab, and what an adapted cap was held to (Hull::adapt_settings), from the fields
/// of a file, if it has them.
template<int D>
void read_slab_fields(const io::Soup& soup, Hull<D>& hull);

/// The points and the cells of a spatial mesh, as the file has them. mesh_of_soup() throws InputError for
/// triangles that do not lie in a plane z = constant.
template<int D>
struct MeshArrays {
    Array<Point<D>> points;
    Array<Simplex<D>> cells;
};
template<int D>
MeshArrays<D> mesh_of_soup(const io::Soup& soup);

} // namespace slabhull
