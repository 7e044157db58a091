// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/percent_text.h"
#include "io/mesh/column_stream.h"
#include "io/vtk/vtk_names.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

namespace {

/// Legacy files are big-endian.
template<class T>
void put_big_endian(char*& out, T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::little) {
        std::reverse(bytes.begin(), bytes.end());
    }
    out = std::copy(bytes.begin(), bytes.end(), out);
}

template<class Stored, class Given>
void write_values(AtomicFile& file, const Column<Given>& column) {
    const auto width = static_cast<std::size_t>(column.components());
    stream_rows(file, column.rows(), sizeof(Stored) * width,
                [&](std::size_t begin, std::size_t end, char* out) {
                    for_each_row(column, begin, end, [&](std::size_t, const Given* values) {
                        for (std::size_t k = 0; k < width; ++k) {
                            put_big_endian(out, static_cast<Stored>(values[k]));
                        }
                    });
                });
    file.write("\n");
}

std::string array_name(const std::string& name) {
    if (name.empty()) {
        throw FormatLimit{"legacy VTK does not hold an array without a name; name it, or write VTU"};
    }
    return percent_encoded(name);
}

/// meshio reads 64 bits only as "long".
template<class Stored>
constexpr const char* legacy_name() {
    return std::floating_point<Stored> ? "double" : sizeof(Stored) == 8 ? "long" : "int";
}

template<class Stored, class Given>
void write_array(AtomicFile& file, const std::string& name, const Column<Given>& column) {
    file.write(fmt::format("{} {} {} {}\n", array_name(name), column.components(), column.rows(),
                           legacy_name<Stored>()));
    write_values<Stored>(file, column);
}

void write_array(AtomicFile& file, const DataColumn& data) {
    std::visit(
        [&](const auto& column) {
            switch (data.type) {
            case Scalar::int64:
                write_array<std::int64_t>(file, data.name, column);
                break;
            case Scalar::int32:
                write_array<std::int32_t>(file, data.name, column);
                break;
            case Scalar::float64:
                write_array<double>(file, data.name, column);
                break;
            }
        },
        data.values);
}

/// Writes texts as bytes, each text ended by a zero, marked by the name of their component. meshio cannot
/// open files with VTK's own string arrays.
void write_texts(AtomicFile& file, const std::string& name, const std::vector<std::string>& texts) {
    std::string bytes;
    for (const std::string& text : texts) {
        bytes += text.substr(0, text.find('\0')) + '\0';
    }
    file.write(fmt::format("{} 1 {} unsigned_char\n", array_name(name), bytes.size()));
    file.write(bytes);
    file.write(fmt::format("\nMETADATA\nCOMPONENT_NAMES\n{}\n\n", text_mark));
}

void write_array(AtomicFile& file, const DataArray& data) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&data.values)) {
        write_texts(file, data.name, *texts);
    } else if (const auto* integers = std::get_if<IntegerList>(&data.values)) {
        write_array<std::int64_t>(file, data.name, integer_column(*integers, data.components));
    } else {
        const auto& reals = std::get<Array<double>>(data.values);
        write_array<double>(file, data.name, Column<double>::over(std::span{reals}, data.components));
    }
}

template<class ArrayLike>
void write_field(AtomicFile& file, const std::vector<ArrayLike>& arrays) {
    if (!arrays.empty()) {
        file.write(fmt::format("FIELD FieldData {}\n", arrays.size()));
    }
    for (const ArrayLike& array : arrays) {
        write_array(file, array);
    }
}

/// Legacy files have ids of 32 bits.
void require_countable(const MeshColumns& mesh) {
    const std::size_t cells = mesh.cells.rows();
    const std::size_t row = static_cast<std::size_t>(mesh.dimension) + 2;
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (cells > most / row || mesh.points.rows() > most) {
        throw FormatLimit(fmt::format("{} cells and {} points are more than the 32 bits of a legacy VTK file "
                                      "count; write VTU",
                                      cells, mesh.points.rows()));
    }
}

void write_cells(AtomicFile& file, const MeshColumns& mesh) {
    const std::size_t cells = mesh.cells.rows();
    const int corners = mesh.dimension + 1;
    const std::size_t row = static_cast<std::size_t>(corners) + 1;
    file.write(fmt::format("CELLS {} {}\n", cells, cells * row));
    stream_rows(file, cells, row * sizeof(std::int32_t), [&](std::size_t begin, std::size_t end, char* out) {
        for_each_row(mesh.cells, begin, end, [&](std::size_t, const std::int64_t* vertices) {
            put_big_endian(out, static_cast<std::int32_t>(corners));
            for (int k = 0; k < corners; ++k) {
                put_big_endian(out, static_cast<std::int32_t>(vertices[k]));
            }
        });
    });
    file.write(fmt::format("\nCELL_TYPES {}\n", cells));
    write_values<std::int32_t>(file, Column<std::int64_t>::constant(cells, vtk_simplex_type(mesh.dimension)));
}

} // namespace

void write_vtk(AtomicFile& file, const MeshColumns& mesh) {
    require_countable(mesh);
    file.write("# vtk DataFile Version 4.2\nwritten by slabhull\nBINARY\nDATASET UNSTRUCTURED_GRID\n");
    write_field(file, mesh.field_data);
    file.write(fmt::format("POINTS {} double\n", mesh.points.rows()));
    write_values<double>(file, mesh.points);
    write_cells(file, mesh);
    if (!mesh.point_data.empty()) {
        file.write(fmt::format("POINT_DATA {}\n", mesh.points.rows()));
        write_field(file, mesh.point_data);
    }
    if (!mesh.cell_data.empty()) {
        file.write(fmt::format("CELL_DATA {}\n", mesh.cells.rows()));
        write_field(file, mesh.cell_data);
    }
}

} // namespace slabhull::io
