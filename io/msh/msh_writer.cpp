// SPDX-License-Identifier: BSD-3-Clause
// The formats are described in the Gmsh reference manual, sections "MSH file format" and "Legacy formats".
#include "slabhull/io/files.h"

#include "io/mesh/column_stream.h"
#include "io/msh/gmsh_types.h"
#include "io/msh/msh_parts.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <utility>

namespace slabhull::io {

namespace {

/// Checks a name, which MSH puts in double quotes without an escape for them.
const std::string& quotable(const std::string& name, const char* whose, const char* other_format) {
    if (name.find_first_of("\"\n\r") != std::string::npos) {
        throw FormatLimit{
            fmt::format("MSH has no place for a double quote or a line end in the name of {}, as "
                        "in {}; rename it, or write {}",
                        whose, name, other_format)};
    }
    return name;
}

/// A row in binary: the values as in memory.
struct BinaryRow {
    static constexpr bool text = false;
    static constexpr std::string_view section_end = "\n"; ///< behind the values of a section
    template<class T>
    static constexpr std::size_t longest = sizeof(T);

    char* out;

    template<class T>
    void value(T value) {
        put(out, value);
    }
    void end() {}
};

/// A row as a line of text; doubles have the fewest digits that read back exactly.
struct TextRow {
    static constexpr bool text = true;
    static constexpr std::string_view section_end = "";
    template<class T>
    static constexpr std::size_t longest = 25; ///< a double takes 24, an integer less; then a blank

    char* out;

    template<class T>
    void value(T value) {
        out = std::to_chars(out, out + longest<T>, value).ptr;
        *out++ = ' ';
    }
    void end() { out[-1] = '\n'; }
};

/// The writer for both versions, in text or binary. Tag is the type of node and element numbers: 64 bits in
/// version 4.1, 32 in version 2.2.
template<class Row, class Tag>
class MshWriter {
public:
    MshWriter(AtomicFile& file, const MshContent& content)
        : content_{content}, mesh_{content.mesh}, parts_{content.parts}, file_{file} {
        for (const MshPart& part : parts_) {
            elements_ += part.cells.rows();
        }
        require_range(mesh_.points.rows(), "nodes");
        require_range(elements_, "elements");
        require_msh_rows(mesh_);
    }

    void write() {
        write_format();
        write_physical_names();
        if constexpr (is_4) {
            write_all_entities();
        }
        section("Nodes", [this] { is_4 ? write_node_block() : write_node_list(); });
        section("Elements", [this] { is_4 ? write_element_blocks() : write_element_list(); });
        for (const DataColumn& data : mesh_.point_data) {
            write_data("NodeData", data, content_.nodes);
        }
        for (const DataColumn& data : mesh_.cell_data) {
            write_data("ElementData", data, parts_.front().tags);
        }
    }

private:
    using Group = MeshColumns::Group;
    static constexpr bool is_4 = sizeof(Tag) == 8;

    static void require_range(std::size_t count, const char* what) {
        if (count > static_cast<std::size_t>(std::numeric_limits<Tag>::max())) {
            throw FormatLimit(
                fmt::format("{} {}, but MSH 2.2 counts in 32 bits; write MSH 4.1", count, what));
        }
    }

    static std::int32_t as_int(std::size_t value) { return static_cast<std::int32_t>(value); }

    template<class Write>
    void section(const char* name, const Write& write) {
        file_.write(fmt::format("${}\n", name));
        write();
        file_.write(fmt::format("{}$End{}\n", Row::section_end, name));
    }

    /// Writes many rows: fill(begin, end, row) makes some of them and ends each.
    template<class Fill>
    void rows(std::size_t count, std::size_t longest, const Fill& fill) {
        stream_text(file_, count, longest, [&](std::size_t begin, std::size_t end, char* out) {
            Row row{out};
            fill(begin, end, row);
            return row.out;
        });
    }

    /// Writes one row of a few values.
    template<class... T>
    void row(T... values) {
        rows(1, (0 + ... + Row::template longest<T>), [&](std::size_t, std::size_t, Row& row) {
            (row.value(values), ...);
            row.end();
        });
    }

    void write_format() {
        file_.write(fmt::format("$MeshFormat\n{} {} 8\n", is_4 ? "4.1" : "2.2", Row::text ? 0 : 1));
        if constexpr (!Row::text) {
            row(std::int32_t{1}); // marks the byte order
            file_.write("\n");
        }
        file_.write("$EndMeshFormat\n");
    }

    void write_physical_names() {
        std::set<std::pair<int, PatchNumber>> named;
        std::string lines;
        for (const MshPart& part : content_.model) {
            for (const Group& group : part.groups) {
                if (group.number > 0 && !group.name.empty() &&
                    named.emplace(part.dimension, group.number).second) {
                    lines += fmt::format("{} {} \"{}\"\n", part.dimension, group.number,
                                         quotable(group.name, "a group", "VTU"));
                }
            }
        }
        if (!named.empty()) {
            file_.write(fmt::format("$PhysicalNames\n{}\n{}$EndPhysicalNames\n", named.size(), lines));
        }
    }

    // --- entities, of version 4.1 only

    /// The discrete entities, numbered from 1 in each dimension, in the box of the whole mesh.
    void write_all_entities() {
        section("Entities", [this] {
            write_entities([](const MshPart&, std::size_t i, Row& row) { row.value(as_int(i + 1)); });
        });
        if (content_.pieces > 0) {
            section("PartitionedEntities", [this] { write_piece_entities(); });
        }
    }

    /// Writes the entities' parts in this piece.
    void write_piece_entities() {
        row(static_cast<Tag>(content_.pieces));
        row(Tag{0}); // number of ghost entities
        write_entities([this](const MshPart& part, std::size_t i, Row& row) {
            row.value(entity_tag(part, i + 1));
            row.value(std::int32_t{part.dimension}); // dimension of the parent
            row.value(as_int(i + 1));
            row.value(Tag{1});
            row.value(as_int(content_.piece + 1));
        });
    }

    /// Tags of the entities' parts come after those of the model's entities, piece by piece.
    std::int32_t entity_tag(const MshPart& part, std::size_t entity) const {
        return as_int(entity + (content_.pieces > 0 ? part.entities->size() * (content_.piece + 1) : 0));
    }

    /// Writes the numbers of entities, then each, by ascending dimension; name(part, i, row) begins its row.
    template<class Name>
    void write_entities(const Name& name) {
        std::array<Tag, 4> counts{};
        for (const MshPart& part : content_.model) {
            counts.at(static_cast<std::size_t>(part.dimension)) = part.entities->size();
        }
        row(counts[0], counts[1], counts[2], counts[3]);
        constexpr std::size_t most_values = 14;
        for (auto part = content_.model.rbegin(); part != content_.model.rend(); ++part) {
            rows(part->entities->size(), most_values * Row::template longest<double>,
                 [&](std::size_t begin, std::size_t end, Row& row) {
                     for (std::size_t i = begin; i < end; ++i) {
                         name(*part, i, row);
                         write_entity(*part, i, row);
                     }
                 });
        }
    }

    void write_entity(const MshPart& part, std::size_t i, Row& row) const {
        const Box& box = content_.box;
        std::for_each(box.min.begin(), box.min.end(), [&](double x) { row.value(x); });
        if (part.dimension > 0) {
            std::for_each(box.max.begin(), box.max.end(), [&](double x) { row.value(x); });
        }
        const PatchNumber group = part.entities->group(i);
        row.value(Tag{group > 0});
        if (group > 0) {
            row.value(group);
        }
        if (part.dimension > 0) {
            row.value(Tag{0}); // number of bounding entities
        }
        row.end();
    }

    // --- nodes

    void write_node_block() {
        const auto count = static_cast<Tag>(mesh_.points.rows());
        const MshTags& tags = content_.nodes;
        row(Tag{1}, count, count > 0 ? static_cast<Tag>(tags(0)) : 0,
            count > 0 ? static_cast<Tag>(tags(count - 1)) : 0);
        row(std::int32_t{mesh_.dimension}, entity_tag(parts_.front(), 1), std::int32_t{0}, count);
        write_nodes(true, false);
        write_nodes(false, true);
    }

    void write_node_list() {
        file_.write(fmt::format("{}\n", mesh_.points.rows()));
        write_nodes(true, true);
    }

    /// Writes rows of the nodes' tags, places, or both.
    void write_nodes(bool tags, bool places) {
        const std::size_t longest =
            (tags ? Row::template longest<Tag> : 0) + (places ? 3 * Row::template longest<double> : 0);
        rows(mesh_.points.rows(), longest, [&](std::size_t begin, std::size_t end, Row& row) {
            const auto put_row = [&](std::size_t node, const double* x) {
                if (tags) {
                    row.value(static_cast<Tag>(content_.nodes(node)));
                }
                std::for_each(x, x + (places ? 3 : 0), [&](double value) { row.value(value); });
                row.end();
            };
            if (places) {
                for_each_row(mesh_.points, begin, end, put_row);
            } else {
                for (std::size_t node = begin; node < end; ++node) {
                    put_row(node, nullptr);
                }
            }
        });
    }

    // --- elements

    static bool filled(const Group& group) { return group.end > group.begin; }

    void write_element_blocks() {
        std::ptrdiff_t blocks = 0;
        std::size_t smallest = 0;
        std::size_t largest = 0;
        for (const MshPart& part : parts_) {
            blocks += std::count_if(part.groups.begin(), part.groups.end(), filled);
            if (const std::size_t count = part.cells.rows(); count > 0) {
                smallest = smallest > 0 ? smallest : part.tags(0);
                largest = part.tags(count - 1);
            }
        }
        row(static_cast<Tag>(blocks), static_cast<Tag>(elements_), static_cast<Tag>(smallest),
            static_cast<Tag>(largest));
        for_each_block([this](const MshPart& part, const Group& group) {
            row(std::int32_t{part.dimension}, entity_tag(part, part.entities->of(group.number)),
                std::int32_t{gmsh_simplex_type(part.dimension)}, static_cast<Tag>(group.end - group.begin));
            write_block(part, group, std::array<Tag, 0>{});
        });
    }

    /// Each element has its type and two tags, group and entity; in binary, the type is in the head of a
    /// block.
    void write_element_list() {
        file_.write(fmt::format("{}\n", elements_));
        for_each_block([this](const MshPart& part, const Group& group) {
            const std::int32_t type = gmsh_simplex_type(part.dimension);
            const std::int32_t entity = as_int(part.entities->of(group.number));
            if constexpr (Row::text) {
                write_block(part, group, std::array<std::int32_t, 4>{type, 2, group.number, entity});
            } else {
                row(type, as_int(group.end - group.begin), std::int32_t{2});
                write_block(part, group, std::array<std::int32_t, 2>{group.number, entity});
            }
        });
    }

    template<class Write>
    void for_each_block(const Write& write) {
        for (const MshPart& part : parts_) {
            for (const Group& group : part.groups) {
                if (filled(group)) {
                    write(part, group);
                }
            }
        }
    }

    /// Writes rows of an element's tag, the values `same` for all, and its nodes' tags.
    template<class Same>
    void write_block(const MshPart& part, const Group& group, const Same& same) {
        const std::size_t corners = static_cast<std::size_t>(part.dimension) + 1;
        rows(group.end - group.begin, (1 + same.size() + corners) * Row::template longest<Tag>,
             [&](std::size_t begin, std::size_t end, Row& row) {
                 for_each_row(
                     part.cells, group.begin + begin, group.begin + end,
                     [&](std::size_t cell, const std::int64_t* vertices) {
                         row.value(static_cast<Tag>(part.tags(cell)));
                         std::for_each(same.begin(), same.end(), [&](auto value) { row.value(value); });
                         std::for_each(vertices, vertices + corners, [&](std::int64_t vertex) {
                             row.value(static_cast<Tag>(content_.nodes(static_cast<std::size_t>(vertex))));
                         });
                         row.end();
                     });
             });
    }

    // --- data

    /// Gmsh reads reals of 3 or 9 components; all others are written component by component.
    void write_data(const char* name, const DataColumn& data, const MshTags& tags) {
        quotable(data.name, "an array", "legacy VTK");
        const int components = components_of(data);
        if (data.type == Scalar::float64 && (components == 3 || components == 9)) {
            write_components(name, data.name, data, 0, components, tags);
            return;
        }
        for (int k = 0; k < components; ++k) {
            write_components(name, components > 1 ? fmt::format("{}_{}", data.name, k) : data.name, data, k,
                             k + 1, tags);
        }
    }

    /// Writes the components [first, last) under one title.
    void write_components(const char* name, const std::string& title, const DataColumn& data, int first,
                          int last, const MshTags& tags) {
        section(name, [&] {
            file_.write(fmt::format("1\n\"{}\"\n1\n0\n3\n0\n{}\n{}\n", title, last - first, rows_of(data)));
            std::visit([&](const auto& column) { write_values(column, first, last, tags); }, data.values);
        });
    }

    template<class T>
    void write_values(const Column<T>& column, int first, int last, const MshTags& tags) {
        const std::size_t longest = Row::template longest<std::int32_t> +
                                    static_cast<std::size_t>(last - first) * Row::template longest<double>;
        rows(column.rows(), longest, [&](std::size_t begin, std::size_t end, Row& row) {
            for_each_row(column, begin, end, [&](std::size_t place, const T* values) {
                row.value(as_int(tags(place)));
                std::for_each(values + first, values + last,
                              [&](T value) { row.value(static_cast<double>(value)); });
                row.end();
            });
        });
    }

    const MshContent& content_;
    const MeshColumns& mesh_;
    const std::vector<MshPart>& parts_;
    std::size_t elements_ = 0;
    AtomicFile& file_;
};

} // namespace

void write_msh(AtomicFile& file, const MshContent& content, const MshOptions& options) {
    const bool is_4 = options.version == MshVersion::v4_1;
    if (options.ascii) {
        is_4 ? MshWriter<TextRow, std::uint64_t>{file, content}.write()
             : MshWriter<TextRow, std::int32_t>{file, content}.write();
    } else {
        is_4 ? MshWriter<BinaryRow, std::uint64_t>{file, content}.write()
             : MshWriter<BinaryRow, std::int32_t>{file, content}.write();
    }
}

void write_msh(AtomicFile& file, const MeshColumns& mesh, const MshOptions& options) {
    const std::vector<MshPart> parts = msh_parts(mesh);
    const bool in_box = options.version == MshVersion::v4_1; // version 2.2 has no entities
    write_msh(file, {mesh, parts, {}, parts, in_box ? box_of(mesh.points) : Box{}}, options);
}

void write_msh(const std::filesystem::path& path, const MeshColumns& mesh, const MshOptions& options) {
    AtomicFile file{path};
    write_msh(file, mesh, options);
    file.commit();
}

} // namespace slabhull::io
