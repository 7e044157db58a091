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

class MshWriter {
public:
    MshWriter(AtomicFile& file, const MeshColumns& mesh)
        : mesh_{mesh}, groups_{groups_of(mesh, "write_msh")}, entities_{entities_of(groups_)}, file_{file} {}

    void write() {
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

    /// The number of each entity's physical group; groups with the same number share an entity.
    static std::vector<PatchNumber> entities_of(const std::vector<Group>& groups) {
        std::vector<PatchNumber> entities;
        for (const Group& group : groups) {
            if (std::find(entities.begin(), entities.end(), group.number) == entities.end()) {
                entities.push_back(group.number);
            }
        }
        return entities;
    }

    std::size_t entity_of(const Group& group) const {
        return 1 + static_cast<std::size_t>(std::find(entities_.begin(), entities_.end(), group.number) -
                                            entities_.begin());
    }

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
        std::set<PatchNumber> named;
        std::string lines;
        for (const Group& group : groups_) {
            if (group.number > 0 && !group.name.empty() && named.insert(group.number).second) {
                lines += fmt::format("{} {} \"{}\"\n", mesh_.dimension, group.number, group.name);
            }
        }
        if (!named.empty()) {
            file_.write(fmt::format("$PhysicalNames\n{}\n{}$EndPhysicalNames\n", named.size(), lines));
        }
    }

    /// The discrete entities, numbered from 1, in the box of the whole mesh.
    void write_entities() {
        file_.write("$Entities\n");
        for (int dimension = 0; dimension <= 3; ++dimension) {
            put_size(dimension == mesh_.dimension ? entities_.size() : 0);
        }
        const Box box = box_of(mesh_.points);
        for (std::size_t i = 0; i < entities_.size(); ++i) {
            put_int(i + 1);
            put_value(box);
            put_size(entities_[i] > 0 ? 1 : 0);
            if (entities_[i] > 0) {
                put_value(entities_[i]);
            }
            put_size(0); // no bounding entities
        }
        file_.write("\n$EndEntities\n");
    }

    void put_block_head(std::size_t entity, std::size_t third, std::size_t count) {
        put_int(static_cast<std::size_t>(mesh_.dimension));
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
        put_block_head(1, 0, count);
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
        file_.write("$Elements\n");
        put_section_head(static_cast<std::size_t>(std::count_if(groups_.begin(), groups_.end(), filled)),
                         mesh_.cells.rows());
        for (const Group& group : groups_) {
            if (filled(group)) {
                write_block(entity_of(group), group);
            }
        }
        file_.write("\n$EndElements\n");
    }

    void write_block(std::size_t entity, const Group& group) {
        const std::size_t corners = static_cast<std::size_t>(mesh_.dimension) + 1;
        const auto type = static_cast<std::size_t>(gmsh_simplex_type(mesh_.dimension));
        put_block_head(entity, type, group.end - group.begin);
        stream_rows(file_, group.end - group.begin, (corners + 1) * sizeof(std::uint64_t),
                    [&](std::size_t begin, std::size_t end, char* out) {
                        for_each_row(mesh_.cells, group.begin + begin, group.begin + end,
                                     [&](std::size_t cell, const std::int64_t* vertices) {
                                         put(out, static_cast<std::uint64_t>(cell + 1));
                                         for (std::size_t k = 0; k < corners; ++k) {
                                             put(out, static_cast<std::uint64_t>(vertices[k] + 1));
                                         }
                                     });
                    });
    }

    void write_data(const char* section, const DataColumn& data) {
        const std::size_t rows = rows_of(data);
        if (rows > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
            throw LimitError(
                fmt::format("\"{}\" has {} rows, but ${} in an MSH file counts in 32 bits; write VTU",
                            data.name, rows, section));
        }
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
    std::vector<Group> groups_;
    std::vector<PatchNumber> entities_;
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
