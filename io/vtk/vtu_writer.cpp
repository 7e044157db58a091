// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/compression.h"
#include "io/files/spool.h"
#include "io/mesh/column_stream.h"
#include "io/mesh/mesh_pieces.h"
#include "io/vtk/vtk_names.h"
#include "io/vtk/xml_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace slabhull::io {

static_assert(std::endian::native == std::endian::little,
              "files are written in the machine's own byte order");

namespace {

/// One array of the file.
struct StoredArray {
    std::string type;
    std::string name;
    int components = 1;
    std::size_t rows = 0;
    std::size_t row_bytes = 0;
    RowFill fill;
    std::string attributes; ///< further attributes, each after a blank

    std::uint64_t bytes() const { return rows * row_bytes; }
};

template<class Stored, class Given>
StoredArray stored(std::string name, const Column<Given>& column) {
    const auto width = static_cast<std::size_t>(column.components());
    return {vtk_name<Stored>(),
            std::move(name),
            column.components(),
            column.rows(),
            sizeof(Stored) * width,
            stored_as<Stored>(column),
            {}};
}

StoredArray stored(const DataColumn& data) {
    return std::visit(
        [&](const auto& column) {
            switch (data.type) {
            case Scalar::int64:
                return stored<std::int64_t>(data.name, column);
            case Scalar::int32:
                return stored<std::int32_t>(data.name, column);
            case Scalar::float64:
                break;
            }
            return stored<double>(data.name, column);
        },
        data.values);
}

/// Indices in Int32 if the largest fits, which halves the file. VTK requires flat arrays, whatever the
/// column's width.
StoredArray stored_indices(std::string name, const Column<std::int64_t>& column, std::size_t largest) {
    StoredArray array = largest <= std::numeric_limits<std::int32_t>::max()
                            ? stored<std::int32_t>(std::move(name), column)
                            : stored<std::int64_t>(std::move(name), column);
    array.components = 1;
    return array;
}

/// Field arrays are small and copied. Texts are bytes, each text ended by a zero: meshio cannot open files
/// with VTK's own string arrays.
StoredArray stored(const DataArray& data) {
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
    if (const auto* integers = std::get_if<IntegerList>(&data.values)) {
        return stored<std::int64_t>(data.name, integer_column(*integers, data.components));
    }
    const auto& reals = std::get<Array<double>>(data.values);
    return stored<double>(data.name, Column<double>::over(std::span<const double>{reals}, data.components));
}

/// The arrays in the order of the file, and the XML around them.
class VtuLayout {
public:
    struct Part {
        std::string before; ///< XML in front of the array's element
        std::string tag;    ///< the open start tag of its element
        StoredArray array;
    };

    void open(const std::string& section) { xml_ += fmt::format("<{}>\n", section); }
    void close(const std::string& section) { xml_ += fmt::format("</{}>\n", section); }

    void add(StoredArray array, bool is_field = false) {
        std::string tag = fmt::format("<DataArray type=\"{}\" Name=\"{}\"", array.type, xml_name(array.name));
        if (array.components > 1) {
            tag += fmt::format(" NumberOfComponents=\"{}\"", array.components);
        }
        if (is_field) {
            tag += fmt::format(" NumberOfTuples=\"{}\"", array.rows);
        }
        tag += array.attributes;
        parts_.push_back({std::exchange(xml_, {}), std::move(tag), std::move(array)});
    }

    const std::vector<Part>& parts() const { return parts_; }
    /// XML after the last array.
    const std::string& end() const { return xml_; }

private:
    std::string xml_;
    std::vector<Part> parts_;
};

/// Bytes of an array in the appended section, and in meshio's unpacked copy of it.
struct ArraySize {
    std::uint64_t in_file = 0;
    std::uint64_t in_copy = 0;
};

/// Whether meshio would confuse arrays. It replaces offsets one after the other by those of its base64 copy
/// and finds the next array by its offset, which may equal a replaced one.
bool leads_meshio_astray(const std::vector<ArraySize>& sizes) {
    std::vector<std::uint64_t> replaced;
    std::uint64_t offset = 0;
    std::uint64_t offset_in_copy = 0;
    for (const ArraySize& size : sizes) {
        if (std::find(replaced.begin(), replaced.end(), offset) != replaced.end()) {
            return true;
        }
        replaced.push_back(offset_in_copy);
        offset += size.in_file;
        offset_in_copy += (size.in_copy + 2) / 3 * 4;
    }
    return false;
}

void add_data(VtuLayout& layout, const std::string& section, const std::vector<DataColumn>& columns) {
    layout.open(section + global_ids_attribute(columns));
    for (const DataColumn& column : columns) {
        layout.add(stored(column));
    }
    layout.close(section);
}

void add_cells(VtuLayout& layout, const MeshColumns& mesh) {
    const std::size_t cells = mesh.cells.rows();
    const auto corners = static_cast<std::size_t>(mesh.dimension) + 1;
    const Column<std::int64_t> ends{cells, 1,
                                    [corners](std::size_t begin, std::size_t end, std::int64_t* out) {
                                        for (std::size_t cell = begin; cell < end; ++cell) {
                                            *out++ = static_cast<std::int64_t>((cell + 1) * corners);
                                        }
                                    }};
    const auto type = static_cast<std::int64_t>(vtk_simplex_type(mesh.dimension));
    layout.open("Cells");
    layout.add(stored_indices("connectivity", mesh.cells, mesh.points.rows()));
    layout.add(stored_indices("offsets", ends, cells * corners));
    layout.add(stored<std::uint8_t>("types", Column<std::int64_t>::constant(cells, type)));
    layout.close("Cells");
}

/// The layout, with a field array of `padding` bytes in front unless that is 0.
VtuLayout lay_out(const MeshColumns& mesh, std::size_t padding) {
    VtuLayout layout;
    layout.open("FieldData");
    if (padding > 0) {
        layout.add(stored<std::uint8_t>("padding", Column<std::int64_t>::constant(padding, 0)), true);
    }
    for (const DataArray& array : mesh.field_data) {
        layout.add(stored(array), true);
    }
    layout.close("FieldData");
    layout.open(fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", mesh.points.rows(),
                            mesh.cells.rows()));
    add_data(layout, "PointData", mesh.point_data);
    add_data(layout, "CellData", mesh.cell_data);
    layout.open("Points");
    layout.add(stored<double>("Points", mesh.points));
    layout.close("Points");
    add_cells(layout, mesh);
    layout.close("Piece");
    return layout;
}

// --- appended arrays ---

std::uint64_t plain_size(const StoredArray& array) {
    return sizeof(std::uint64_t) + array.bytes();
}

void write_appended_xml(AtomicFile& file, const VtuLayout& layout, const std::vector<ArraySize>& sizes) {
    std::uint64_t offset = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const VtuLayout::Part& part = layout.parts()[i];
        file.write(part.before + part.tag + fmt::format(" format=\"appended\" offset=\"{}\"/>\n", offset));
        offset += sizes[i].in_file;
    }
    file.write(layout.end() + "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
}

std::vector<ArraySize> plain_sizes(const VtuLayout& layout) {
    std::vector<ArraySize> sizes;
    for (const VtuLayout::Part& part : layout.parts()) {
        sizes.push_back({plain_size(part.array), plain_size(part.array)});
    }
    return sizes;
}

void write_raw(AtomicFile& file, const MeshColumns& mesh) {
    std::size_t padding = 0;
    VtuLayout layout = lay_out(mesh, padding);
    while (leads_meshio_astray(plain_sizes(layout))) {
        layout = lay_out(mesh, ++padding);
    }
    write_appended_xml(file, layout, plain_sizes(layout));
    for (const VtuLayout::Part& part : layout.parts()) {
        const std::uint64_t size = part.array.bytes();
        file.write(&size, sizeof size);
        stream_rows(file, part.array.rows, part.array.row_bytes, part.array.fill);
    }
    file.write("\n</AppendedData>\n");
}

// --- packed arrays ---

/// Number of rows in a block of about a quarter of a megabyte.
std::size_t block_rows_of(const StoredArray& array) {
    constexpr std::size_t block_bytes = std::size_t{256} << 10;
    return std::max<std::size_t>(1, block_bytes / std::max<std::size_t>(1, array.row_bytes));
}

/// An array whose packed blocks are in a spool, as their sizes must come before them in the file.
struct PackedArray {
    std::vector<std::uint64_t>
        head; ///< blocks, bytes of one, bytes of a shorter last one, packed bytes of each
    std::uint64_t begin = 0;
    std::uint64_t bytes = 0;
    ArraySize size;
};

PackedArray packed(const StoredArray& array, Compressor compressor, Spool& spool) {
    const std::size_t rows = block_rows_of(array);
    PackedArray result{{0, rows * array.row_bytes, array.rows % rows * array.row_bytes}, spool.size(), 0, {}};
    stream_blocks(
        array.rows, rows, array.row_bytes, array.fill,
        [compressor](std::string_view bytes) { return pack(compressor, bytes); },
        [&](const std::string& block) {
            spool.write(block);
            ++result.head.front();
            result.head.push_back(block.size());
        });
    result.bytes = spool.size() - result.begin;
    result.size = {result.head.size() * sizeof(std::uint64_t) + result.bytes, plain_size(array)};
    return result;
}

std::vector<ArraySize> packed_sizes(const std::vector<PackedArray>& arrays) {
    std::vector<ArraySize> sizes;
    for (const PackedArray& array : arrays) {
        sizes.push_back(array.size);
    }
    return sizes;
}

/// The offsets in the XML depend on the packed sizes, so the arrays are packed first.
void write_packed(AtomicFile& file, const MeshColumns& mesh, Compressor compressor) {
    Spool spool{file.folder()};
    std::vector<PackedArray> arrays;
    VtuLayout layout = lay_out(mesh, 0);
    for (const VtuLayout::Part& part : layout.parts()) {
        arrays.push_back(packed(part.array, compressor, spool));
    }
    for (std::size_t padding = 1; leads_meshio_astray(packed_sizes(arrays)); ++padding) {
        layout = lay_out(mesh, padding);
        arrays.erase(arrays.begin(), arrays.begin() + (padding > 1 ? 1 : 0));
        arrays.insert(arrays.begin(), packed(layout.parts().front().array, compressor, spool));
    }
    write_appended_xml(file, layout, packed_sizes(arrays));
    for (const PackedArray& array : arrays) {
        file.write(array.head.data(), array.head.size() * sizeof(std::uint64_t));
        spool.copy(array.begin, array.bytes, file);
    }
    file.write("\n</AppendedData>\n");
}

// --- text ---

/// The fewest digits that read back exactly.
template<class T>
std::string printed(std::string_view bytes, std::size_t row_bytes) {
    constexpr std::size_t longest = 32;
    std::array<char, longest> digits;
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
        T value;
        std::memcpy(&value, bytes.data() + at, sizeof(T));
        const auto end = std::to_chars(digits.begin(), digits.end(), value).ptr;
        text.append(digits.begin(), end);
        text += (at + sizeof(T)) % row_bytes == 0 ? '\n' : ' ';
    }
    return text;
}

void write_ascii(AtomicFile& file, const MeshColumns& mesh) {
    const VtuLayout layout = lay_out(mesh, 0);
    for (const VtuLayout::Part& part : layout.parts()) {
        const StoredArray& array = part.array;
        file.write(part.before + part.tag + " format=\"ascii\">\n");
        with_vtk_type(array.type, [&](auto zero) {
            const auto print = [&](std::string_view bytes) {
                return printed<decltype(zero)>(bytes, array.row_bytes);
            };
            stream_blocks(array.rows, block_rows_of(array), array.row_bytes, array.fill, print,
                          [&](const std::string& text) { file.write(text); });
        });
        file.write("</DataArray>\n");
    }
    file.write(layout.end() + "</UnstructuredGrid>\n");
}

const char* compressor_attribute(VtuEncoding encoding) {
    return encoding == VtuEncoding::zlib  ? " compressor=\"vtkZLibDataCompressor\""
           : encoding == VtuEncoding::lz4 ? " compressor=\"vtkLZ4DataCompressor\""
                                          : "";
}

} // namespace

void write_vtu(AtomicFile& file, const MeshColumns& mesh, VtuEncoding encoding) {
    file.write(fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                           "byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n<UnstructuredGrid>\n",
                           compressor_attribute(encoding)));
    switch (encoding) {
    case VtuEncoding::raw:
        write_raw(file, mesh);
        break;
    case VtuEncoding::zlib:
        write_packed(file, mesh, Compressor::zlib);
        break;
    case VtuEncoding::lz4:
        write_packed(file, mesh, Compressor::lz4);
        break;
    case VtuEncoding::ascii:
        write_ascii(file, mesh);
        break;
    }
    file.write("</VTKFile>\n");
}

void write_vtu(const std::filesystem::path& path, const MeshColumns& mesh, VtuEncoding encoding) {
    AtomicFile file{path};
    write_vtu(file, mesh, encoding);
    file.commit();
}

} // namespace slabhull::io
