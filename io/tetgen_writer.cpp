// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "percent_text.h"
#include "slabhull/core/error.h"
#include "tetgen_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace slabhull::io {

namespace {

template<class T>
void append(std::string& text, T value) {
    std::array<char, 32> digits; // the longest double has 24
    const auto [end, problem] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end);
    text += ' ';
}

/// A column's values in rows [begin, end), to be asked for one row after the other.
class ColumnText {
public:
    explicit ColumnText(DataColumn data) : data_{std::move(data)} {}

    void load(std::size_t begin, std::size_t end) {
        std::visit(
            [&](const auto& column) {
                auto& values = values_of(column);
                values.resize((end - begin) * static_cast<std::size_t>(column.components()));
                column.fill(begin, end, values.data());
            },
            data_.values);
        next_ = 0;
    }

    void append_row(std::string& text) {
        std::visit(
            [&](const auto& column) {
                for (int k = 0; k < column.components(); ++k) {
                    const auto value = values_of(column)[next_++];
                    data_.type == Scalar::float64 ? append(text, static_cast<double>(value))
                                                  : append(text, static_cast<std::int64_t>(value));
                }
            },
            data_.values);
    }

private:
    std::vector<double>& values_of(const Column<double>&) { return reals_; }
    std::vector<std::int64_t>& values_of(const Column<std::int64_t>&) { return integers_; }

    DataColumn data_;
    std::vector<double> reals_;
    std::vector<std::int64_t> integers_;
    std::size_t next_ = 0;
};

void write_rows(AtomicFile& file, std::size_t rows, const std::vector<DataColumn>& columns) {
    constexpr std::size_t chunk = 4096;
    std::vector<ColumnText> texts;
    for (const DataColumn& column : columns) {
        texts.emplace_back(column);
    }
    std::string block;
    for (std::size_t begin = 0; begin < rows; begin += chunk) {
        const std::size_t end = std::min(rows, begin + chunk);
        for (ColumnText& text : texts) {
            text.load(begin, end);
        }
        block.clear();
        for (std::size_t row = begin; row < end; ++row) {
            for (ColumnText& text : texts) {
                text.append_row(block);
            }
            block.back() = '\n';
        }
        file.write(block);
    }
}

DataColumn integers(std::string name, Column<std::int64_t> column) {
    return {std::move(name), Scalar::int64, std::move(column)};
}

DataColumn row_numbers(std::size_t rows) {
    return integers("",
                    Column<std::int64_t>{rows, 1, [](std::size_t begin, std::size_t end, std::int64_t* out) {
                                             for (std::size_t row = begin; row < end; ++row) {
                                                 *out++ = static_cast<std::int64_t>(row);
                                             }
                                         }});
}

int width_of(const DataColumn& data) {
    return std::visit([](const auto& column) { return column.components(); }, data.values);
}

const DataColumn* find(const std::vector<DataColumn>& columns, const std::string& name, int components) {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const DataColumn& column) {
        return column.name == name && width_of(column) == components && column.type != Scalar::float64;
    });
    return found == columns.end() ? nullptr : &*found;
}

std::vector<DataColumn> without(std::vector<DataColumn> columns, const DataColumn* one) {
    if (one != nullptr) {
        const std::string name = one->name;
        std::erase_if(columns, [&](const DataColumn& column) { return column.name == name; });
    }
    return columns;
}

/// Number of each cell's group, 0 for none. The groups stand in the order of the cells.
Column<std::int64_t> group_numbers(const MeshColumns& mesh) {
    const auto number_of = [groups = mesh.groups](std::size_t cell) {
        const auto group = std::partition_point(groups.begin(), groups.end(),
                                                [cell](const auto& one) { return one.end <= cell; });
        return group == groups.end() || cell < group->begin ? 0 : group->number;
    };
    return {mesh.cells.rows(), 1, [number_of](std::size_t begin, std::size_t end, std::int64_t* out) {
                for (std::size_t cell = begin; cell < end; ++cell) {
                    *out++ = number_of(cell);
                }
            }};
}

class TetgenWriter {
public:
    TetgenWriter(const std::filesystem::path& stem, const MeshColumns& mesh) : stem_{stem}, mesh_{mesh} {}

    void write() {
        if (mesh_.dimension < 2) {
            throw UsageError(fmt::format(
                "{}: TetGen's files hold triangles or tetrahedra, not lines; write VTU", stem_.string()));
        }
        write_nodes();
        mesh_.dimension == 3 ? write_tetrahedra() : write_triangles();
        for (const auto& file :
             files_) { // so that what can fail has not failed before the first gets its name
            file->finish();
        }
        for (const auto& file : files_) {
            file->commit();
        }
    }

private:
    AtomicFile& open(const char* extension) {
        std::filesystem::path path = stem_;
        path += extension;
        return *files_.emplace_back(std::make_unique<AtomicFile>(path));
    }

    /// Rows of a number, the leading column, attributes, and perhaps a marker, below a line of counts.
    static void write_table(AtomicFile& file, const std::string& shape, const DataColumn& leading,
                            const std::vector<DataColumn>& attributes, const DataColumn* marker) {
        const std::size_t rows = std::visit([](const auto& column) { return column.rows(); }, leading.values);
        std::vector<DataColumn> columns{row_numbers(rows), leading};
        std::string told;
        int width = 0;
        for (const DataColumn& data : attributes) {
            told += fmt::format(" {}:{}:{}", percent_encoded(data.name),
                                data.type == Scalar::float64 ? "real" : "integer", width_of(data));
            width += width_of(data);
            columns.push_back(data);
        }
        if (marker != nullptr) {
            columns.push_back(*marker);
        }
        if (width > 0) {
            file.write(fmt::format("{}{}\n", attribute_mark, told));
        }
        file.write(fmt::format("{} {} {}{}\n", rows, shape, width,
                               shape == "3" ? marker != nullptr ? " 1" : " 0" : ""));
        write_rows(file, rows, columns);
    }

    void write_nodes() {
        const DataColumn* marker = find(mesh_.point_data, "marker", 1);
        write_table(open(".node"), "3", {"", Scalar::float64, mesh_.points},
                    without(mesh_.point_data, marker), marker);
    }

    void write_tetrahedra() {
        const DataColumn* neighbors = find(mesh_.cell_data, "neighbors", 4);
        std::vector<DataColumn> attributes = without(mesh_.cell_data, neighbors);
        if (!mesh_.groups.empty() && find(attributes, "group", 1) == nullptr) {
            attributes.insert(attributes.begin(), integers("group", group_numbers(mesh_)));
        }
        write_table(open(".ele"), "4", integers("", mesh_.cells), attributes, nullptr);
        if (neighbors != nullptr) {
            AtomicFile& file = open(".neigh");
            file.write(fmt::format("{} 4\n", mesh_.cells.rows()));
            write_rows(file, mesh_.cells.rows(), {row_numbers(mesh_.cells.rows()), *neighbors});
        }
    }

    std::optional<DataColumn> triangle_markers() const {
        for (const char* name : {"marker", "patch"}) {
            if (const DataColumn* found = find(mesh_.cell_data, name, 1)) {
                return *found;
            }
        }
        return mesh_.groups.empty() ? std::nullopt : std::optional{integers("group", group_numbers(mesh_))};
    }

    void write_triangles() {
        const std::size_t rows = mesh_.cells.rows();
        const std::optional<DataColumn> marker = triangle_markers();
        std::vector<DataColumn> columns{row_numbers(rows), integers("", mesh_.cells)};
        if (marker) {
            columns.push_back(*marker);
        }
        AtomicFile& faces = open(".face");
        faces.write(fmt::format("{} {}\n", rows, marker ? 1 : 0));
        write_rows(faces, rows, columns);
        columns.front() =
            integers("", Column<std::int64_t>::constant(rows, 3)); // corners instead of a number
        AtomicFile& complex = open(".smesh");
        complex.write(fmt::format("0 3 0 0\n{} {}\n", rows, marker ? 1 : 0));
        write_rows(complex, rows, columns);
        write_places(complex, "holes", 3);
        write_places(complex, "regions", 5);
    }

    void write_places(AtomicFile& file, const std::string& name, int width) const {
        const auto found =
            std::find_if(mesh_.field_data.begin(), mesh_.field_data.end(), [&](const DataArray& array) {
                return array.name == name && array.components == width &&
                       std::holds_alternative<Array<double>>(array.values);
            });
        if (found == mesh_.field_data.end()) {
            file.write("0\n");
            return;
        }
        const auto& values = std::get<Array<double>>(found->values);
        const auto column = Column<double>::over(std::span<const double>{values}, width);
        file.write(fmt::format("{}\n", column.rows()));
        write_rows(file, column.rows(), {row_numbers(column.rows()), {"", Scalar::float64, column}});
    }

    std::filesystem::path stem_;
    const MeshColumns& mesh_;
    std::vector<std::unique_ptr<AtomicFile>> files_;
};

} // namespace

void write_tetgen(const std::filesystem::path& stem, const MeshColumns& mesh) {
    TetgenWriter{stem, mesh}.write();
}

} // namespace slabhull::io
