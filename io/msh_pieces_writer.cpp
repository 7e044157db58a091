// SPDX-License-Identifier: BSD-3-Clause
// The format is described in the Gmsh reference manual, section "MSH file format"; the files are those of its
// option Mesh.PartitionSplitMeshFiles.
#include "slabhull/io/files.h"

#include "column_stream.h"
#include "gmsh_types.h"
#include "mesh_pieces.h"
#include "msh_parts.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

namespace slabhull::io {

namespace {

/// What all pieces have in common.
struct Whole {
    explicit Whole(const MeshColumns& the_mesh, std::size_t count)
        : mesh{the_mesh}, pieces{count}, parts{msh_parts(the_mesh)}, box{box_of(the_mesh.points)} {}

    const MeshColumns& mesh;
    std::size_t pieces;
    std::vector<MshPart> parts;
    Box box;
};

class MshPieceWriter {
public:
    MshPieceWriter(AtomicFile& file, const Whole& whole, const MeshPiece& piece, std::size_t number)
        : file_{file}, whole_{whole}, piece_{piece}, number_{number} {
        parts_.push_back({whole.parts.front(), piece.mesh.cells, piece.mesh.groups,
                          [first = piece.first_cell](std::size_t row) { return first + row + 1; }});
        for (std::size_t i = 0; i < piece.lower.size(); ++i) {
            const MshPart& part = whole.parts[i + 1];
            const auto& rows = piece.lower[i];
            if (rows->size() > 0) {
                parts_.push_back({part, piece.mesh.lower[i].cells, piece.mesh.lower[i].groups,
                                  [rows, before = part.tags_before](std::size_t row) {
                                      return before + rows->member(row) + 1;
                                  }});
            }
        }
        for (LocalPart& part : parts_) {
            if (part.groups.empty()) {
                part.groups.push_back({0, part.cells.rows(), 0, {}});
            }
        }
    }

    void write() {
        write_msh_head(file_, whole_.mesh, whole_.box);
        write_entities();
        write_nodes();
        write_elements();
        write_all_data("NodeData", piece_.mesh.point_data,
                       [this](std::size_t row) { return piece_.points->member(row) + 1; });
        write_all_data("ElementData", piece_.mesh.cell_data, parts_.front().tag);
    }

private:
    using Group = MeshColumns::Group;
    using Tag = std::function<std::size_t(std::size_t row)>;

    /// The simplices of one dimension in the piece.
    struct LocalPart {
        const MshPart& whole;
        const Column<std::int64_t>& cells; ///< vertices numbered within the piece
        std::vector<Group> groups;
        Tag tag; ///< of a row
    };

    template<class T>
    void put_value(T value) {
        file_.write(&value, sizeof value);
    }
    void put_int(std::size_t value) { put_value(static_cast<std::int32_t>(value)); }
    void put_size(std::size_t value) { put_value(static_cast<std::uint64_t>(value)); }

    /// The pieces of an entity follow the entities of the model, by piece.
    std::size_t tag_of_entity(const MshPart& part, std::size_t entity) const {
        return part.entities.size() * (number_ + 1) + entity;
    }

    void write_entities() {
        file_.write("$PartitionedEntities\n");
        put_size(whole_.pieces);
        put_size(0); // no ghosts
        for (int dimension = 0; dimension <= 3; ++dimension) {
            const MshPart* part = part_of(dimension);
            put_size(part != nullptr ? part->entities.size() : 0);
        }
        for (int dimension = 0; dimension <= 3; ++dimension) {
            if (const MshPart* part = part_of(dimension)) {
                write_entities(*part);
            }
        }
        file_.write("\n$EndPartitionedEntities\n");
    }

    const MshPart* part_of(int dimension) const {
        const auto found = std::find_if(whole_.parts.begin(), whole_.parts.end(),
                                        [=](const MshPart& part) { return part.dimension == dimension; });
        return found == whole_.parts.end() ? nullptr : &*found;
    }

    void write_entities(const MshPart& part) {
        for (std::size_t i = 0; i < part.entities.size(); ++i) {
            put_int(tag_of_entity(part, i + 1));
            put_int(static_cast<std::size_t>(part.dimension)); // the parent's
            put_int(i + 1);
            put_size(1);
            put_int(number_ + 1); // partition
            part.dimension == 0 ? put_value(whole_.box.min) : put_value(whole_.box);
            put_size(part.entities[i] > 0 ? 1 : 0);
            if (part.entities[i] > 0) {
                put_value(part.entities[i]);
            }
            if (part.dimension > 0) {
                put_size(0); // no bounding entities
            }
        }
    }

    void write_nodes() {
        const PointSet& points = *piece_.points;
        const std::size_t count = points.size();
        file_.write("$Nodes\n");
        put_size(1);
        put_size(count);
        put_size(points.member(0) + 1);
        put_size(points.member(count - 1) + 1);
        put_int(static_cast<std::size_t>(whole_.mesh.dimension));
        put_int(tag_of_entity(whole_.parts.front(), 1));
        put_int(0); // no parameters
        put_size(count);
        stream_rows(file_, count, sizeof(std::uint64_t), [&](std::size_t begin, std::size_t end, char* out) {
            for (std::size_t row = begin, point = points.member(begin); row < end; ++row) {
                put(out, static_cast<std::uint64_t>(point + 1));
                point = row + 1 < end ? points.next(point) : point;
            }
        });
        stream_rows(file_, count, 3 * sizeof(double), stored_as<double>(piece_.mesh.points));
        file_.write("\n$EndNodes\n");
    }

    void write_elements() {
        std::size_t blocks = 0;
        std::size_t elements = 0;
        for (const LocalPart& part : parts_) {
            blocks += part.groups.size();
            elements += part.cells.rows();
        }
        const LocalPart& last = parts_.back();
        file_.write("$Elements\n");
        put_size(blocks);
        put_size(elements);
        put_size(parts_.front().tag(0)); // the tags of the cells come first
        put_size(last.tag(last.cells.rows() - 1));
        for (const LocalPart& part : parts_) {
            for (const Group& group : part.groups) {
                write_block(part, group);
            }
        }
        file_.write("\n$EndElements\n");
    }

    void write_block(const LocalPart& part, const Group& group) {
        const std::size_t corners = static_cast<std::size_t>(part.whole.dimension) + 1;
        put_int(static_cast<std::size_t>(part.whole.dimension));
        put_int(tag_of_entity(part.whole, part.whole.entity_of(group)));
        put_int(static_cast<std::size_t>(gmsh_simplex_type(part.whole.dimension)));
        put_size(group.end - group.begin);
        stream_rows(file_, group.end - group.begin, (corners + 1) * sizeof(std::uint64_t),
                    [&](std::size_t begin, std::size_t end, char* out) {
                        for_each_row(
                            part.cells, group.begin + begin, group.begin + end,
                            [&](std::size_t cell, const std::int64_t* vertices) {
                                put(out, static_cast<std::uint64_t>(part.tag(cell)));
                                std::for_each(vertices, vertices + corners, [&](std::int64_t vertex) {
                                    put(out,
                                        static_cast<std::uint64_t>(
                                            piece_.points->member(static_cast<std::size_t>(vertex)) + 1));
                                });
                            });
                    });
    }

    void write_all_data(const char* section, const std::vector<DataColumn>& columns, const Tag& tag) {
        for (const DataColumn& data : columns) {
            if (data.name != global_points && data.name != global_cells) { // the tags tell that
                write_data(section, data, tag);
            }
        }
    }

    void write_data(const char* section, const DataColumn& data, const Tag& tag) {
        for_each_msh_array(data, [&](const std::string& title, int first, int last) {
            file_.write(fmt::format("${}\n1\n\"{}\"\n1\n0\n3\n0\n{}\n{}\n", section, title, last - first,
                                    rows_of(data)));
            std::visit([&](const auto& column) { write_components(column, first, last, tag); }, data.values);
            file_.write(fmt::format("\n$End{}\n", section));
        });
    }

    template<class T>
    void write_components(const Column<T>& column, int first, int last, const Tag& tag) {
        const auto width = static_cast<std::size_t>(last - first);
        stream_rows(file_, column.rows(), sizeof(std::int32_t) + width * sizeof(double),
                    [&](std::size_t begin, std::size_t end, char* out) {
                        for_each_row(column, begin, end, [&](std::size_t row, const T* values) {
                            put(out, static_cast<std::int32_t>(tag(row)));
                            std::for_each(values + first, values + last,
                                          [&](T value) { put(out, static_cast<double>(value)); });
                        });
                    });
    }

    AtomicFile& file_;
    const Whole& whole_;
    const MeshPiece& piece_;
    std::size_t number_; ///< of the piece, from 0
    std::vector<LocalPart> parts_;
};

} // namespace

void write_msh_pieces(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                      std::size_t pieces, const MshOptions& options) {
    if (options.ascii || options.version != MshVersion::v4_1) {
        throw UsageError{fmt::format("{}: MSH in pieces is version 4.1, binary", path.string())};
    }
    require_msh_rows(mesh);
    const Whole whole{mesh, pieces};
    MeshPieces parts{mesh, pieces};
    for (std::size_t number = 0; !parts.at_end(); ++number) {
        const MeshPiece piece = parts.next();
        AtomicFile& file = files.open(piece_path(path, number + 1, ".msh"));
        MshPieceWriter{file, whole, piece, number}.write();
        file.finish();
    }
}

} // namespace slabhull::io
