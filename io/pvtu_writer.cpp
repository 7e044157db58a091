// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "Parallel file formats".
#include "slabhull/io/files.h"

#include "column_stream.h"
#include "mesh_pieces.h"
#include "vtk_names.h"
#include "xml_text.h"

#include <deque>
#include <fmt/format.h>

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
                       escaped(name), components);
}

std::string section(const char* name, const std::vector<DataColumn>& data) {
    std::string xml = fmt::format("<{}{}>\n", name, global_ids_attribute(data));
    for (const DataColumn& column : data) {
        xml += array_tag(type_of(column), column.name, components_of(column));
    }
    return xml + fmt::format("</{}>\n", name);
}

/// What all pieces have in common.
std::string head_of(const MeshColumns& piece) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
           "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n" +
           section("PPointData", piece.point_data) + section("PCellData", piece.cell_data) + "<PPoints>\n" +
           array_tag(vtk_name<double>(), "Points", 3) + "</PPoints>\n";
}

} // namespace

void write_pvtu(const std::filesystem::path& path, const MeshColumns& mesh, std::size_t pieces,
                VtuEncoding encoding) {
    std::deque<AtomicFile> files;
    AtomicFile whole{path};
    MeshPieces parts{mesh, pieces};
    for (std::size_t number = 0; !parts.at_end(); ++number) {
        const MeshPiece piece = parts.next();
        const std::filesystem::path name = piece_path(path, number, ".vtu");
        if (number == 0) {
            whole.write(head_of(piece.mesh));
        }
        write_vtu(files.emplace_back(name), piece.mesh, encoding);
        files.back().finish();
        whole.write(fmt::format("<Piece Source=\"{}\"/>\n", escaped(name.filename().string())));
    }
    whole.write("</PUnstructuredGrid>\n</VTKFile>\n");
    whole.finish();
    for (AtomicFile& file : files) {
        file.commit();
    }
    whole.commit();
}

} // namespace slabhull::io
