// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/files/percent_text.h"
#include "io/others/tetgen_names.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <optional>

namespace slabhull::io {

namespace {

template<class T>
void append(std::string& text, T value) {
    std::array<char, 32> digits; // a double takes at most 24
    const auto [end, problem] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end);
    text += ' ';
}

/// A column's values as text, row after row.
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

/// Writes a line for each row; with `break_after`, two lines, the first with that many columns.
void write_rows(AtomicFile& file, std::size_t rows, const std::vector<DataColumn>& columns,
                std::size_t break_after = 0) {
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
            for (std::size_t k = 0; k < texts.size(); ++k) {
                texts[k].append_row(block);
                if (k + 1 == break_after || k + 1 == texts.size()) {
                    block.back() = '\n';
                }
            }
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

/// Number of each cell's group, 0 for none. Groups are in the order of the cells.
DataColumn group_numbers(std::size_t cells, std::vector<MeshColumns::Group> given) {
    const auto number_of = [groups = std::move(given)](std::size_t cell) {
        const auto group = std::partition_point(groups.begin(), groups.end(),
                                                [cell](const auto& one) { return one.end <= cell; });
        return group == groups.end() || cell < group->begin ? 0 : group->number;
    };
    const auto fill = [number_of](std::size_t begin, std::size_t end, std::int64_t* out) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            *out++ = number_of(cell);
        }
    };
    return integers(group_attribute, Column<std::int64_t>{cells, 1, fill});
}

class TetgenWriter {
public:
    /// `complex`: the extension of the file that holds triangles as facets of a domain.
    TetgenWriter(AtomicFiles& files, const std::filesystem::path& stem, const char* complex,
                 const MeshColumns& mesh)
        : files_{files}, stem_{stem}, complex_{complex}, mesh_{mesh} {}

    void write() {
        if (mesh_.dimension < 2) {
            throw FormatLimit(fmt::format(
                "{}: TetGen's files hold triangles or tetrahedra, not lines; write VTU", stem_.string()));
        }
        write_nodes();
        mesh_.dimension == 3 ? write_tetrahedra() : write_triangles();
        require_no_others();
    }

private:
    std::filesystem::path path_of(const char* extension) const {
        std::filesystem::path path = stem_;
        path += extension;
        return path;
    }
    AtomicFile& open(const char* extension) { return files_.open(path_of(extension)); }

    /// Refuses files of another mesh with the same stem, which would be read together with ours.
    void require_no_others() const {
        const auto& ours = files_.paths();
        for (const char* extension : {".ele", ".neigh", ".face"}) {
            const std::filesystem::path path = path_of(extension);
            if (std::find(ours.begin(), ours.end(), path) == ours.end() && std::filesystem::exists(path)) {
                throw OutputError(fmt::format("{}: stands there already and would be taken for a part of the "
                                              "new mesh, which has no such file; remove it",
                                              path.string()));
            }
        }
    }

    /// Writes a line of counts, then rows of a number, the leading column, attributes, and optionally a
    /// marker.
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
        if (!mesh_.groups.empty() && find(attributes, group_attribute, 1) == nullptr) {
            attributes.insert(attributes.begin(), group_numbers(mesh_.cells.rows(), mesh_.groups));
        }
        write_table(open(".ele"), "4", integers("", mesh_.cells), attributes, nullptr);
        if (neighbors != nullptr) {
            AtomicFile& file = open(".neigh");
            file.write(fmt::format("{} 4\n", mesh_.cells.rows()));
            write_rows(file, mesh_.cells.rows(), {row_numbers(mesh_.cells.rows()), *neighbors});
        }
        for (const MeshColumns::Part& part : mesh_.lower) {
            if (part.dimension == 2) {
                write_faces(part.cells, group_markers(part.cells, part.groups));
            }
        }
    }

    static std::optional<DataColumn> group_markers(const Column<std::int64_t>& cells,
                                                   const std::vector<MeshColumns::Group>& groups) {
        return groups.empty() ? std::nullopt : std::optional{group_numbers(cells.rows(), groups)};
    }

    std::optional<DataColumn> triangle_markers() const {
        for (const char* name : {"marker", "patch"}) {
            if (const DataColumn* found = find(mesh_.cell_data, name, 1)) {
                return *found;
            }
        }
        return group_markers(mesh_.cells, mesh_.groups);
    }

    void write_triangles() {
        const std::optional<DataColumn> marker = triangle_markers();
        write_faces(mesh_.cells, marker);
        AtomicFile& file = open(complex_);
        file.write(fmt::format("0 3 0 0\n{} {}\n", mesh_.cells.rows(), marker ? 1 : 0));
        write_facets(file, marker);
        write_places(file, "holes", 3);
        write_places(file, "regions", 5);
    }

    void write_faces(const Column<std::int64_t>& triangles, const std::optional<DataColumn>& marker) {
        std::vector<DataColumn> columns{row_numbers(triangles.rows()), integers("", triangles)};
        if (marker) {
            columns.push_back(*marker);
        }
        AtomicFile& file = open(".face");
        file.write(fmt::format("{} {}\n", triangles.rows(), marker ? 1 : 0));
        write_rows(file, triangles.rows(), columns);
    }

    /// A facet in a .smesh is a line of 3, corners and marker; in a .poly, a line of 1 polygon, 0 holes and
    /// marker, then one of 3 and the corners.
    void write_facets(AtomicFile& file, const std::optional<DataColumn>& marker) const {
        const std::size_t rows = mesh_.cells.rows();
        const auto all = [rows](std::int64_t value) {
            return integers("", Column<std::int64_t>::constant(rows, value));
        };
        const bool nested = complex_ == std::string_view{".poly"};
        std::vector<DataColumn> columns{all(3), integers("", mesh_.cells)};
        const std::vector<DataColumn> marks(marker ? 1 : 0, marker.value_or(DataColumn{}));
        columns.insert(nested ? columns.begin() : columns.end(), marks.begin(), marks.end());
        if (nested) {
            columns.insert(columns.begin(), {all(1), all(0)});
        }
        write_rows(file, rows, columns, nested ? 2 + marks.size() : 0);
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

    AtomicFiles& files_;
    std::filesystem::path stem_;
    const char* complex_;
    const MeshColumns& mesh_;
};

} // namespace

void write_tetgen(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh) {
    constexpr std::array<std::string_view, 2> of_tetrahedra{".node", ".ele"};
    constexpr std::array<std::string_view, 4> of_triangles{".node", ".face", ".smesh", ".poly"};
    const std::string extension = lower_extension(path);
    const auto among = [&](const auto& names) {
        return std::find(names.begin(), names.end(), extension) != names.end();
    };
    const bool known = among(of_tetrahedra) || among(of_triangles);
    if (known && !(mesh.dimension == 3 ? among(of_tetrahedra) : among(of_triangles))) {
        throw FormatLimit(fmt::format("{}: has no place for {}; TetGen keeps them in files called {}",
                                      path.string(), mesh.dimension == 3 ? "tetrahedra" : "these cells",
                                      mesh.dimension == 3 ? ".node and .ele"
                                                          : ".node, .face, .smesh and .poly, if triangles"));
    }
    const auto stem = known ? std::filesystem::path{path}.replace_extension() : path;
    TetgenWriter{files, stem, extension == ".poly" ? ".poly" : ".smesh", mesh}.write();
}

void write_tetgen(const std::filesystem::path& stem, const MeshColumns& mesh) {
    AtomicFiles files;
    TetgenWriter{files, stem, ".smesh", mesh}.write();
    files.commit();
}

} // namespace slabhull::io
