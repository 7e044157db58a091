// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "Parallel file formats".
#include "slabhull/io/files.h"

#include "io/mesh/column_stream.h"
#include "io/mesh/mesh_pieces.h"
#include "io/vtk/vtk_names.h"
#include "io/vtk/xml_text.h"

#include <fmt/format.h>
#include <utility>

namespace slabhull::io {

namespace {

const char* type_of(const DataColumn& data) {
    switch (data.type) {
    case Scalar::int64:
        return vtk_name<std::int64_t>();
    case Scalar::int32:
        return vtk_name<std::int32_t>();
    case Scalar::float64:
        break;
    }
    return vtk_name<double>();
}

std::string array_tag(const char* type, const std::string& name, int components) {
    return fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", type,
                       xml_name(name), components);
}

std::string section(const char* name, const std::vector<DataColumn>& data) {
    std::string xml = fmt::format("<{}{}>\n", name, global_ids_attribute(data));
    for (const DataColumn& column : data) {
        xml += array_tag(type_of(column), column.name, components_of(column));
    }
    return xml + fmt::format("</{}>\n", name);
}

/// The XML that describes what all pieces have in common.
std::string head_of(const MeshColumns& piece) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
           "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n" +
           section("PPointData", piece.point_data) + section("PCellData", piece.cell_data) + "<PPoints>\n" +
           array_tag(vtk_name<double>(), "Points", 3) + "</PPoints>\n";
}

void write_vtu_of_piece(AtomicFiles& files, const std::filesystem::path& path, const MeshPiece& piece,
                        std::size_t number, VtuEncoding encoding) {
    AtomicFile& file = files.open(piece_path(path, number, ".vtu"));
    write_vtu(file, piece.mesh, encoding);
    file.finish();
}

/// The .pvtu: the head that any piece gives, and the names of all.
void write_index(AtomicFiles& files, const std::filesystem::path& path, std::string xml, std::size_t pieces) {
    for (std::size_t number = 0; number < pieces; ++number) {
        xml += fmt::format("<Piece Source=\"{}\"/>\n",
                           escaped(piece_path(path, number, ".vtu").filename().string()));
    }
    files.open(path).write(xml + "</PUnstructuredGrid>\n</VTKFile>\n");
}

} // namespace

void write_pvtu(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                std::size_t pieces, VtuEncoding encoding) {
    MeshPieces parts{mesh, pieces};
    std::string head;
    for (std::size_t number = 0; !parts.at_end(); ++number) {
        const MeshPiece piece = parts.next();
        if (number == 0) {
            head = head_of(piece.mesh);
        }
        write_vtu_of_piece(files, path, piece, number, encoding);
    }
    write_index(files, path, std::move(head), pieces);
}

void write_pvtu_piece(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& columns,
                      VtuEncoding encoding) {
    const MeshPiece piece = mesh_piece(columns);
    write_vtu_of_piece(files, path, piece, columns.number, encoding);
    if (columns.number == 0) {
        write_index(files, path, head_of(piece.mesh), columns.pieces);
    }
}

} // namespace slabhull::io
