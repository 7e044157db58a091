// SPDX-License-Identifier: BSD-3-Clause
// The MSH 4.1 format is described in the Gmsh reference manual, section "MSH file format".
#include "slabhull/io/files.h"

#include "cell_groups.h"
#include "column_stream.h"
#include "gmsh_types.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <utility>

namespace slabhull::io {

namespace {

struct Box {
    Point<3> min;
    Point<3> max;
};

Box box_of(const Column<double>& points) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr std::size_t grain = 65536;
    const std::size_t pieces = (points.rows() + grain - 1) / grain;
    std::vector<Box> boxes(pieces, {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}});
    parallel_for(points.rows(), grain, [&](std::size_t begin, std::size_t end) {
        Box& box = boxes[begin / grain];
        for_each_row(points, begin, end, [&](std::size_t, const double* x) {
            for (std::size_t i = 0; i < 3; ++i) {
                box.min[i] = std::min(box.min[i], x[i]);
                box.max[i] = std::max(box.max[i], x[i]);
            }
        });
    });
    Box whole = boxes.empty() ? Box{} : boxes.front();
    for (const Box& box : boxes) {
        for (std::size_t i = 0; i < 3; ++i) {
            whole.min[i] = std::min(whole.min[i], box.min[i]);
            whole.max[i] = std::max(whole.max[i], box.max[i]);
        }
    }
    return whole;
}

/// The cells of one dimension.
struct Part {
    using Group = MeshColumns::Group;

    int dimension;
    const Column<std::int64_t>& cells;
    std::vector<Group> groups;
    std::vector<PatchNumber> entities; ///< the number of each one's physical group; groups may share one
    std::size_t tags_before = 0;       ///< element tags used before this part's

    Part(int its_dimension, const Column<std::int64_t>& its_cells, const std::vector<Group>& given)
        : dimension{its_dimension}, cells{its_cells}, groups{checked_groups(its_cells, given, "write_msh")} {
        for (const Group& group : groups) {
            if (std::find(entities.begin(), entities.end(), group.number) == entities.end()) {
                entities.push_back(group.number);
            }
        }
    }

    std::size_t entity_of(const Group& group) const {
        const auto place = std::find(entities.begin(), entities.end(), group.number);
        return 1 + static_cast<std::size_t>(place - entities.begin());
    }
};

/// The name of a group as MSH has it, in double quotes, for which there is no escape.
const std::string& quotable(const std::string& name) {
    if (name.find_first_of("\"\n\r") != std::string::npos) {
        throw UsageError{fmt::format("MSH has no place for a double quote or a line end in the name of a "
                                     "group, as in {}",
                                     name)};
    }
    return name;
}

class MshWriter {
public:
    MshWriter(AtomicFile& file, const MeshColumns& mesh) : mesh_{mesh}, file_{file} {
        parts_.emplace_back(mesh.dimension, mesh.cells, mesh.groups);
        for (const MeshColumns::Part& part : mesh.lower) {
            parts_.emplace_back(part.dimension, part.cells, part.groups);
        }
        for (Part& part : parts_) {
            part.tags_before = elements_;
            elements_ += part.cells.rows();
        }
    }

    void write() {
        require_rows("NodeData", mesh_.point_data);
        require_rows("ElementData", mesh_.cell_data);
        write_format();
        write_physical_names();
        write_entities();
        write_nodes();
        write_elements();
        for (const DataColumn& data : mesh_.point_data) {
            write_data("NodeData", data);
        }
        for (const DataColumn& data : mesh_.cell_data) {
            write_data("ElementData", data);
        }
    }

private:
    using Group = MeshColumns::Group;

    template<class T>
    void put_value(T value) {
        file_.write(&value, sizeof value);
    }
    void put_int(std::size_t value) { put_value(static_cast<std::int32_t>(value)); }
    void put_size(std::size_t value) { put_value(static_cast<std::uint64_t>(value)); }

    void write_format() {
        file_.write("$MeshFormat\n4.1 1 8\n");
        put_int(1); // tells the byte order
        file_.write("\n$EndMeshFormat\n");
    }

    void write_physical_names() {
        std::set<std::pair<int, PatchNumber>> named;
        std::string lines;
        for (const Part& part : parts_) {
            for (const Group& group : part.groups) {
                if (group.number > 0 && !group.name.empty() &&
                    named.emplace(part.dimension, group.number).second) {
                    lines +=
                        fmt::format("{} {} \"{}\"\n", part.dimension, group.number, quotable(group.name));
                }
            }
        }
        if (!named.empty()) {
            file_.write(fmt::format("$PhysicalNames\n{}\n{}$EndPhysicalNames\n", named.size(), lines));
        }
    }

    /// The discrete entities, numbered from 1 in each dimension, in the box of the whole mesh.
    void write_entities() {
        file_.write("$Entities\n");
        for (int dimension = 0; dimension <= 3; ++dimension) {
            const Part* part = part_of(dimension);
            put_size(part != nullptr ? part->entities.size() : 0);
        }
        const Box box = box_of(mesh_.points);
        for (int dimension = 0; dimension <= 3; ++dimension) {
            if (const Part* part = part_of(dimension)) {
                write_entities(*part, box);
            }
        }
        file_.write("\n$EndEntities\n");
    }

    const Part* part_of(int dimension) const {
        const auto found = std::find_if(parts_.begin(), parts_.end(),
                                        [=](const Part& part) { return part.dimension == dimension; });
        return found == parts_.end() ? nullptr : &*found;
    }

    void write_entities(const Part& part, const Box& box) {
        for (std::size_t i = 0; i < part.entities.size(); ++i) {
            put_int(i + 1);
            part.dimension == 0 ? put_value(box.min) : put_value(box);
            put_size(part.entities[i] > 0 ? 1 : 0);
            if (part.entities[i] > 0) {
                put_value(part.entities[i]);
            }
            if (part.dimension > 0) {
                put_size(0); // no bounding entities
            }
        }
    }

    void put_block_head(int dimension, std::size_t entity, std::size_t third, std::size_t count) {
        put_int(static_cast<std::size_t>(dimension));
        put_int(entity);
        put_int(third);
        put_size(count);
    }

    /// Counts of blocks and things, smallest and largest tag.
    void put_section_head(std::size_t blocks, std::size_t count) {
        put_size(blocks);
        put_size(count);
        put_size(count > 0 ? 1 : 0);
        put_size(count);
    }

    void write_nodes() {
        const std::size_t count = mesh_.points.rows();
        file_.write("$Nodes\n");
        put_section_head(1, count);
        put_block_head(mesh_.dimension, 1, 0, count);
        stream_rows(file_, count, sizeof(std::uint64_t), [](std::size_t begin, std::size_t end, char* out) {
            for (std::size_t tag = begin + 1; tag <= end; ++tag) {
                put(out, static_cast<std::uint64_t>(tag));
            }
        });
        stream_rows(file_, count, 3 * sizeof(double), stored_as<double>(mesh_.points));
        file_.write("\n$EndNodes\n");
    }

    void write_elements() {
        const auto filled = [](const Group& group) { return group.end > group.begin; };
        std::ptrdiff_t blocks = 0;
        for (const Part& part : parts_) {
            blocks += std::count_if(part.groups.begin(), part.groups.end(), filled);
        }
        file_.write("$Elements\n");
        put_section_head(static_cast<std::size_t>(blocks), elements_);
        for (const Part& part : parts_) {
            for (const Group& group : part.groups) {
                if (filled(group)) {
                    write_block(part, group);
                }
            }
        }
        file_.write("\n$EndElements\n");
    }

    void write_block(const Part& part, const Group& group) {
        const std::size_t corners = static_cast<std::size_t>(part.dimension) + 1;
        const auto type = static_cast<std::size_t>(gmsh_simplex_type(part.dimension));
        const std::size_t tag = part.tags_before + 1;
        put_block_head(part.dimension, part.entity_of(group), type, group.end - group.begin);
        stream_rows(file_, group.end - group.begin, (corners + 1) * sizeof(std::uint64_t),
                    [&](std::size_t begin, std::size_t end, char* out) {
                        for_each_row(part.cells, group.begin + begin, group.begin + end,
                                     [&](std::size_t cell, const std::int64_t* vertices) {
                                         put(out, static_cast<std::uint64_t>(cell + tag));
                                         for (std::size_t k = 0; k < corners; ++k) {
                                             put(out, static_cast<std::uint64_t>(vertices[k] + 1));
                                         }
                                     });
                    });
    }

    /// Before anything is written, as what cannot be must not take an hour to say.
    static void require_rows(const char* section, const std::vector<DataColumn>& columns) {
        for (const DataColumn& data : columns) {
            const std::size_t rows = rows_of(data);
            if (rows > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
                throw LimitError(
                    fmt::format("\"{}\" has {} rows, but ${} in an MSH file counts in 32 bits; write VTU",
                                data.name, rows, section));
            }
        }
    }

    void write_data(const char* section, const DataColumn& data) {
        const std::size_t rows = rows_of(data);
        const int components = components_of(data);
        for (int k = 0; k < components; ++k) {
            const std::string name = components > 1 ? fmt::format("{}_{}", data.name, k) : data.name;
            file_.write(fmt::format("${}\n1\n\"{}\"\n1\n0\n3\n0\n1\n{}\n", section, name, rows));
            std::visit([&](const auto& column) { write_component(column, k); }, data.values);
            file_.write(fmt::format("\n$End{}\n", section));
        }
    }

    template<class T>
    void write_component(const Column<T>& column, int component) {
        stream_rows(file_, column.rows(), sizeof(std::int32_t) + sizeof(double),
                    [&](std::size_t begin, std::size_t end, char* out) {
                        for_each_row(column, begin, end, [&](std::size_t row, const T* values) {
                            put(out, static_cast<std::int32_t>(row + 1));
                            put(out, static_cast<double>(values[component]));
                        });
                    });
    }

    const MeshColumns& mesh_;
    std::vector<Part> parts_; ///< the cells first, so that their tags are their numbers from 1
    std::size_t elements_ = 0;
    AtomicFile& file_;
};

} // namespace

void write_msh(AtomicFile& file, const MeshColumns& mesh) {
    MshWriter{file, mesh}.write();
}

void write_msh(const std::filesystem::path& path, const MeshColumns& mesh) {
    AtomicFile file{path};
    write_msh(file, mesh);
    file.commit();
}

} // namespace slabhull::io
