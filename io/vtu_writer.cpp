// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "column_stream.h"
#include "vtk_names.h"
#include "xml_text.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

static_assert(std::endian::native == std::endian::little,
              "files are written in the machine's own byte order");

namespace {

/// One array of the appended section.
struct AppendedArray {
    std::string type;
    std::string name;
    int components = 1;
    std::size_t rows = 0;
    std::size_t row_bytes = 0;
    RowFill fill;
    std::string attributes; ///< further ones, each after a blank

    std::uint64_t bytes() const { return rows * row_bytes; }
};

template<class Stored, class Given>
AppendedArray appended(std::string name, const Column<Given>& column) {
    const auto width = static_cast<std::size_t>(column.components());
    return {vtk_name<Stored>(),
            std::move(name),
            column.components(),
            column.rows(),
            sizeof(Stored) * width,
            stored_as<Stored>(column),
            {}};
}

AppendedArray appended(const DataColumn& data) {
    return std::visit(
        [&](const auto& column) {
            switch (data.type) {
            case Scalar::int64:
                return appended<std::int64_t>(data.name, column);
            case Scalar::int32:
                return appended<std::int32_t>(data.name, column);
            case Scalar::float64:
                break;
            }
            return appended<double>(data.name, column);
        },
        data.values);
}

/// Int32 where the largest value fits, which halves the file. VTK wants these arrays flat, whatever the
/// column's width.
AppendedArray appended_indices(std::string name, const Column<std::int64_t>& column, std::size_t largest) {
    AppendedArray array = largest <= std::numeric_limits<std::int32_t>::max()
                              ? appended<std::int32_t>(std::move(name), column)
                              : appended<std::int64_t>(std::move(name), column);
    array.components = 1;
    return array;
}

/// Field arrays are small and copied. Texts are bytes, each text ended by a zero: VTK's own string arrays
/// would keep meshio from opening the file at all.
AppendedArray appended(const DataArray& data) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&data.values)) {
        std::string bytes;
        for (const std::string& text : *texts) {
            bytes += text.substr(0, text.find('\0')) + '\0';
        }
        const auto fill = [bytes](std::size_t begin, std::size_t end, char* out) {
            bytes.copy(out, end - begin, begin);
        };
        return {vtk_name<std::uint8_t>(),           data.name, 1, bytes.size(), 1, fill,
                fmt::format(" {}=\"1\"", text_mark)};
    }
    if (const auto* integers = std::get_if<Array<std::int64_t>>(&data.values)) {
        return appended<std::int64_t>(
            data.name, Column<std::int64_t>::over(std::span<const std::int64_t>{*integers}, data.components));
    }
    const auto& reals = std::get<Array<double>>(data.values);
    return appended<double>(data.name, Column<double>::over(std::span<const double>{reals}, data.components));
}

/// The arrays by their place in the file, and the XML that tells of them.
class VtuLayout {
public:
    void open(const std::string& section) { xml_ += fmt::format("<{}>\n", section); }
    void close(const std::string& section) { xml_ += fmt::format("</{}>\n", section); }

    void add(AppendedArray array, bool is_field = false) {
        xml_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\"", array.type, escaped(array.name));
        if (array.components > 1) {
            xml_ += fmt::format(" NumberOfComponents=\"{}\"", array.components);
        }
        if (is_field) {
            xml_ += fmt::format(" NumberOfTuples=\"{}\"", array.rows);
        }
        xml_ += fmt::format("{} format=\"appended\" offset=\"{}\"/>\n", array.attributes, offset_);
        offset_ += sizeof(std::uint64_t) + array.bytes();
        arrays_.push_back(std::move(array));
    }

    /// meshio replaces offsets by those of its base64 copy one after the other, and finds the next array by
    /// its offset: one that equals a replaced offset leads it astray.
    bool leads_meshio_astray() const {
        std::vector<std::uint64_t> replaced;
        std::uint64_t offset = 0;
        std::uint64_t offset_in_copy = 0;
        for (const AppendedArray& array : arrays_) {
            if (std::find(replaced.begin(), replaced.end(), offset) != replaced.end()) {
                return true;
            }
            replaced.push_back(offset_in_copy);
            const std::uint64_t bytes = sizeof(std::uint64_t) + array.bytes();
            offset += bytes;
            offset_in_copy += (bytes + 2) / 3 * 4;
        }
        return false;
    }

    void write(AtomicFile& file) const {
        file.write(xml_);
        file.write("</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
        for (const AppendedArray& array : arrays_) {
            const std::uint64_t size = array.bytes();
            file.write(&size, sizeof size);
            stream_rows(file, array.rows, array.row_bytes, array.fill);
        }
    }

private:
    std::string xml_;
    std::vector<AppendedArray> arrays_;
    std::uint64_t offset_ = 0;
};

void add_data(VtuLayout& layout, const std::string& section, const std::vector<DataColumn>& columns) {
    layout.open(section);
    for (const DataColumn& column : columns) {
        layout.add(appended(column));
    }
    layout.close(section);
}

void add_cells(VtuLayout& layout, const MeshColumns& mesh) {
    const std::size_t cells = mesh.cells.rows();
    const auto corners = static_cast<std::size_t>(mesh.dimension + 1);
    const Column<std::int64_t> ends{cells, 1,
                                    [corners](std::size_t begin, std::size_t end, std::int64_t* out) {
                                        for (std::size_t cell = begin; cell < end; ++cell) {
                                            *out++ = static_cast<std::int64_t>((cell + 1) * corners);
                                        }
                                    }};
    const auto type = static_cast<std::int64_t>(vtk_simplex_type(mesh.dimension));
    layout.open("Cells");
    layout.add(appended_indices("connectivity", mesh.cells, mesh.points.rows()));
    layout.add(appended_indices("offsets", ends, cells * corners));
    layout.add(appended<std::uint8_t>("types", Column<std::int64_t>::constant(cells, type)));
    layout.close("Cells");
}

/// With a field array of `padding` bytes in front, where that is not 0.
VtuLayout lay_out(const MeshColumns& mesh, std::size_t padding) {
    VtuLayout layout;
    layout.open("FieldData");
    if (padding > 0) {
        layout.add(appended<std::uint8_t>("padding", Column<std::int64_t>::constant(padding, 0)), true);
    }
    for (const DataArray& array : mesh.field_data) {
        layout.add(appended(array), true);
    }
    layout.close("FieldData");
    layout.open(fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", mesh.points.rows(),
                            mesh.cells.rows()));
    add_data(layout, "PointData", mesh.point_data);
    add_data(layout, "CellData", mesh.cell_data);
    layout.open("Points");
    layout.add(appended<double>("Points", mesh.points));
    layout.close("Points");
    add_cells(layout, mesh);
    layout.close("Piece");
    return layout;
}

} // namespace

void write_vtu(AtomicFile& file, const MeshColumns& mesh) {
    std::size_t padding = 0;
    VtuLayout layout = lay_out(mesh, padding);
    while (layout.leads_meshio_astray()) {
        layout = lay_out(mesh, ++padding);
    }
    file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
               "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n");
    layout.write(file);
    file.write("\n</AppendedData>\n</VTKFile>\n");
}

void write_vtu(const std::filesystem::path& path, const MeshColumns& mesh) {
    AtomicFile file{path};
    write_vtu(file, mesh);
    file.commit();
}

} // namespace slabhull::io
