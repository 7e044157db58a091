// SPDX-License-Identifier: BSD-3-Clause
// The format is described in the Gmsh reference manual, section "MSH file format"; the files are those of its
// option Mesh.PartitionSplitMeshFiles.
#include "io/mesh/mesh_pieces.h"
#include "io/msh/msh_parts.h"
#include "slabhull/core/error.h"
#include "slabhull/io/files.h"

#include <fmt/format.h>

namespace slabhull::io {

namespace {

/// The simplices of a piece, with the entities and the tags that they have in the whole mesh.
std::vector<MshPart> parts_of(const MeshPiece& piece, const std::vector<MshPart>& model) {
    std::vector<MshPart> parts = msh_parts(piece.mesh);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i].entities = model[i].entities;
        parts[i].tags = model[i].tags;
    }
    parts.front().tags.before += piece.first_cell;
    for (std::size_t i = 0; i < piece.lower.size(); ++i) {
        parts[i + 1].tags.members = piece.lower[i].get();
    }
    return parts;
}

/// These arrays would repeat the element and node tags.
void drop_global_numbers(std::vector<DataColumn>& data) {
    std::erase_if(
        data, [](const DataColumn& each) { return each.name == global_points || each.name == global_cells; });
}

void require_pieces(const std::filesystem::path& path, const MshOptions& options) {
    if (options.ascii || options.version != MshVersion::v4_1) {
        throw UsageError{fmt::format("{}: MSH in pieces is version 4.1, binary", path.string())};
    }
}

void write_msh_of_piece(AtomicFiles& files, const std::filesystem::path& path, MeshPiece&& piece,
                        const std::vector<MshPart>& model, const Box& box, std::size_t pieces,
                        std::size_t number, const MshOptions& options) {
    drop_global_numbers(piece.mesh.point_data);
    drop_global_numbers(piece.mesh.cell_data);
    AtomicFile& file = files.open(piece_path(path, number + 1, ".msh"));
    write_msh(file, {piece.mesh, parts_of(piece, model), {0, piece.points.get()}, model, box, pieces, number},
              options);
    file.finish();
}

} // namespace

void write_msh_pieces(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                      std::size_t pieces, const MshOptions& options) {
    require_pieces(path, options);
    require_msh_rows(mesh);
    const std::vector<MshPart> model = msh_parts(mesh);
    const Box box = box_of(mesh.points);
    MeshPieces parts{mesh, pieces};
    for (std::size_t number = 0; !parts.at_end(); ++number) {
        write_msh_of_piece(files, path, parts.next(), model, box, pieces, number, options);
    }
}

void write_msh_piece(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& piece,
                     const MshOptions& options) {
    require_pieces(path, options);
    require_msh_rows(piece.mesh);
    MeshColumns whole; // its cells are only counted
    whole.dimension = piece.mesh.dimension;
    whole.cells = {piece.all_cells, whole.dimension + 1, nullptr};
    whole.groups = piece.groups;
    write_msh_of_piece(files, path, mesh_piece(piece), msh_parts(whole),
                       {piece.lower_corner, piece.upper_corner}, piece.pieces, piece.number, options);
}

} // namespace slabhull::io
