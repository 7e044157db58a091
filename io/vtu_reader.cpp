// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "XML File Formats".
#include "slabhull/io/files.h"

#include "byte_order.h"
#include "file_cursor.h"
#include "slabhull/core/text.h"
#include "vtk_names.h"
#include "vtu_payload.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <fmt/format.h>
#include <optional>
#include <pugixml.hpp>
#include <utility>

namespace slabhull::io {

namespace {

/// The appended section, which is no XML and which the XML parser never sees.
struct Appended {
    std::size_t begin = std::string_view::npos; ///< of the tag, in the file
    std::string_view data;                      ///< what follows the underscore
    bool is_base64 = false;
};

Appended find_appended(std::string_view bytes) {
    Appended appended;
    appended.begin = bytes.find("<AppendedData");
    if (appended.begin == std::string_view::npos) {
        return appended;
    }
    const std::size_t tag_end = std::min(bytes.find('>', appended.begin), bytes.size());
    const std::string_view tag = bytes.substr(appended.begin, tag_end - appended.begin);
    appended.is_base64 = tag.find("base64") != std::string_view::npos;
    const std::size_t mark = bytes.find('_', tag_end);
    appended.data = mark == std::string_view::npos ? std::string_view{} : bytes.substr(mark + 1);
    return appended;
}

/// An array's values as they stand in the file: bytes, or text.
struct Stored {
    std::string_view text;
    Payload payload;
    bool is_text = false;
};

constexpr std::uint64_t any_count = std::numeric_limits<std::uint64_t>::max();

/// The product, or the largest number where it is larger.
std::uint64_t times(std::uint64_t a, std::uint64_t b) {
    return b > 0 && a > any_count / b ? any_count : a * b;
}

class VtuReader {
public:
    VtuReader(std::string_view bytes, const std::string& path)
        : bytes_{bytes}, appended_{find_appended(bytes)} {
        soup_.path = path;
    }

    Soup read() {
        parse_xml();
        const pugi::xml_node grid = open_grid();
        for (const pugi::xml_node node : grid.child("FieldData").children()) {
            soup_.field_data.push_back(data_array(node, std::nullopt));
        }
        for (const pugi::xml_node piece : grid.children("Piece")) {
            read_piece(piece);
        }
        if (dimension_ == 0) {
            fail(grid, "there are no cells");
        }
        return std::move(soup_);
    }

private:
    [[noreturn]] void fail_at(std::ptrdiff_t byte, const std::string& text) const {
        throw InputError(fmt::format("{}: byte {}: {}", soup_.path, byte, readable(text)),
                         {Entity{"byte", byte, {}}});
    }
    [[noreturn]] void fail(const pugi::xml_node& node, const std::string& text) const {
        const std::string name = node.attribute("Name").value();
        const std::string what = name.empty() ? node.name() : "array \"" + name + "\"";
        fail_at(node.offset_debug(), fmt::format("{}: {}", what, text));
    }

    // --- XML ---

    void parse_xml() {
        std::string head;
        std::string_view xml = bytes_;
        if (appended_.begin != std::string_view::npos) {
            head = std::string{bytes_.substr(0, appended_.begin)} + "</VTKFile>";
            xml = head;
        }
        const pugi::xml_parse_result result =
            document_.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!result) {
            fail_at(result.offset, fmt::format("this is no VTU file: {}", result.description()));
        }
    }

    pugi::xml_node open_grid() {
        const pugi::xml_node file = document_.child("VTKFile");
        const std::string_view type = file.attribute("type").value();
        if (type != "UnstructuredGrid") {
            fail_at(0, fmt::format("a VTKFile of type UnstructuredGrid was expected, not \"{}\"", type));
        }
        const std::string_view order = file.attribute("byte_order").as_string("LittleEndian");
        if (order != "LittleEndian" && order != "BigEndian") {
            fail(file, fmt::format("the byte order \"{}\" is not known", order));
        }
        format_.swapped = (order == "LittleEndian") != (std::endian::native == std::endian::little);
        const std::string_view word = file.attribute("header_type").as_string("UInt32");
        if (word != "UInt32" && word != "UInt64") {
            fail(file, fmt::format("the header type \"{}\" is not known", word));
        }
        format_.word_bytes = word == "UInt64" ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
        format_.compressor = compressor_of(file);
        return file.child("UnstructuredGrid");
    }

    Compressor compressor_of(const pugi::xml_node& file) const {
        const std::string_view name = file.attribute("compressor").value();
        if (name == "vtkZLibDataCompressor") {
            return Compressor::zlib;
        }
        if (name == "vtkLZ4DataCompressor") {
            return Compressor::lz4;
        }
        if (!name.empty()) {
            fail(file,
                 fmt::format("files compressed by {} are not read; save it with zlib, LZ4 or without", name));
        }
        return Compressor::none;
    }

    std::uint64_t count_attribute(const pugi::xml_node& node, const char* name) const {
        const std::string_view text = node.attribute(name).value();
        std::uint64_t value = 0;
        const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (problem != std::errc{} || stop != text.data() + text.size()) {
            fail(node, fmt::format("{}=\"{}\" is no count", name, text));
        }
        return value;
    }

    // --- arrays ---

    /// `most` bytes where it is packed.
    Stored stored(const pugi::xml_node& node, std::uint64_t most) {
        const std::string_view format = node.attribute("format").as_string("ascii");
        if (format == "ascii") {
            return {node.text().get(), {}, true};
        }
        if (format == "binary") {
            std::string_view text = node.text().get();
            text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
            return {{}, payload(node, text, true, most), false};
        }
        if (format != "appended") {
            fail(node, fmt::format("the format \"{}\" is not known", format));
        }
        const std::uint64_t offset = count_attribute(node, "offset");
        if (offset > appended_.data.size()) {
            fail(node, fmt::format("offset {} lies beyond the end of the file", offset));
        }
        return {{}, payload(node, appended_.data.substr(offset), appended_.is_base64, most), false};
    }

    /// Arrays that share bytes could make a small file a large mesh.
    Payload payload(const pugi::xml_node& node, std::string_view data, bool is_base64, std::uint64_t most) {
        try {
            Payload result = read_payload(format_, data, is_base64, most);
            consumed_ += result.consumed;
            if (consumed_ > bytes_.size()) {
                fail(node, "its data overlap those of other arrays");
            }
            return result;
        } catch (const PayloadError& problem) {
            fail(node, problem.what());
        }
    }

    /// All values as T, each by convert(value) from the type in the file. Packed arrays that hold more than
    /// `count` are refused.
    template<class T, class Convert>
    Array<T> values(const pugi::xml_node& node, std::uint64_t count, const Convert& convert) {
        Array<T> result;
        const bool known = with_vtk_type(node.attribute("type").value(), [&](auto zero) {
            using S = decltype(zero);
            const Stored source = stored(node, times(count, sizeof(S)));
            if (source.is_text) {
                parse_text<S>(node, source.text, result, convert);
            } else {
                unpack_values<S>(node, source.payload.bytes, result, convert);
            }
        });
        if (!known) {
            fail(node, fmt::format("the type \"{}\" is not read", node.attribute("type").value()));
        }
        return result;
    }

    template<class S, class T, class Convert>
    void unpack_values(const pugi::xml_node& node, std::string_view bytes, Array<T>& result,
                       const Convert& convert) const {
        if (bytes.size() % sizeof(S) != 0) {
            fail(node, fmt::format("{} bytes are no whole number of values", bytes.size()));
        }
        result.resize(bytes.size() / sizeof(S));
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = convert(load<S>(bytes.data() + i * sizeof(S), format_.swapped));
        }
    }

    template<class S, class T, class Convert>
    void parse_text(const pugi::xml_node& node, std::string_view text, Array<T>& result,
                    const Convert& convert) const {
        const std::string array = readable(node.attribute("Name").value());
        FileCursor cursor{text, fmt::format("{}: array \"{}\"", soup_.path, array)};
        while (!cursor.at_end()) {
            if constexpr (sizeof(S) == 1) { // a number, not a character
                const int value = cursor.parsed<int>("a number");
                if (!std::in_range<S>(value)) {
                    cursor.fail(fmt::format("{} does not fit its type", value));
                }
                result.push_back(convert(static_cast<S>(value)));
            } else {
                result.push_back(convert(cursor.parsed<S>("a number")));
            }
        }
    }

    template<class T>
    Array<T> plain(const pugi::xml_node& node, std::uint64_t count) {
        return values<T>(node, count, [&](auto value) {
            if constexpr (std::integral<T> && std::same_as<decltype(value), std::uint64_t>) {
                if (!std::in_range<T>(value)) {
                    fail(node, fmt::format("{} is too large", value));
                }
            }
            return static_cast<T>(value);
        });
    }

    // --- mesh ---

    /// Behind what the pieces before have given.
    void read_piece(const pugi::xml_node& piece) {
        const std::uint64_t points = count_attribute(piece, "NumberOfPoints");
        const std::uint64_t cells = count_attribute(piece, "NumberOfCells");
        if (points == 0 && cells == 0) { // as parallel writers leave them, perhaps without arrays
            return;
        }
        first_point_ = soup_.points.size();
        read_points(piece, points);
        read_cells(piece, cells);
        read_data(soup_.point_data, piece, "PointData", points);
        read_data(soup_.cell_data, piece, "CellData", cells);
        is_first_piece_ = false;
    }

    void read_points(const pugi::xml_node& piece, std::uint64_t count) {
        const pugi::xml_node node = piece.child("Points").child("DataArray");
        const Array<double> x = plain<double>(node, times(3, count));
        if (x.size() % 3 != 0 || x.size() / 3 != count) {
            fail(node, fmt::format("{} values are no {} points of 3 coordinates", x.size(), count));
        }
        checked_index(first_point_ + count, "points");
        const auto bad =
            std::find_if_not(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
        if (bad != x.end()) {
            fail(node,
                 fmt::format("point {} has a coordinate that is not a finite number", (bad - x.begin()) / 3));
        }
        soup_.points.resize(first_point_ + count);
        if (!x.empty()) {
            std::memcpy(soup_.points.data() + first_point_, x.data(), x.size() * sizeof(double));
        }
    }

    void read_cells(const pugi::xml_node& piece, std::uint64_t count) {
        const pugi::xml_node section = piece.child("Cells");
        const auto array = [&](const char* name) {
            const pugi::xml_node node = section.find_child_by_attribute("DataArray", "Name", name);
            if (!node) {
                fail(piece, fmt::format("the array \"{}\" is missing", name));
            }
            if (std::string_view{node.attribute("type").value()}.starts_with("Float")) {
                fail(node, "integers were expected, not reals");
            }
            return node;
        };
        check_types(array("types"), count);
        const std::size_t corners = dimension_ + 1;
        check_offsets(array("offsets"), count, corners);
        read_connectivity(array("connectivity"), times(count, corners), corners);
    }

    /// The first cell of all decides what the mesh is made of.
    void check_types(const pugi::xml_node& node, std::uint64_t claimed) {
        const Array<std::int64_t> types = plain<std::int64_t>(node, claimed);
        if (types.size() != claimed) {
            fail(node, fmt::format("{} cells are claimed, {} types are there", claimed, types.size()));
        }
        checked_index(types.size(), "cells");
        if (dimension_ == 0 && !types.empty()) {
            dimension_ = dimension_of(types.front());
        }
        const auto other = std::find_if(types.begin(), types.end(), [&](std::int64_t type) {
            return type != vtk_simplex_type(static_cast<int>(dimension_));
        });
        if (other != types.end()) {
            fail(node, fmt::format("cell {} is a {}; only lines, only triangles or only tetrahedra are read",
                                   other - types.begin(), vtk_type_name(static_cast<int>(*other & 0xFF))));
        }
    }

    /// 1 for what is no simplex, too: it is refused with a name then.
    static std::size_t dimension_of(std::int64_t type) {
        int dimension = 3;
        while (dimension > 1 && type != vtk_simplex_type(dimension)) {
            --dimension;
        }
        return static_cast<std::size_t>(dimension);
    }

    void check_offsets(const pugi::xml_node& node, std::size_t cells, std::size_t corners) {
        const Array<std::int64_t> offsets = plain<std::int64_t>(node, cells);
        if (offsets.size() != cells) {
            fail(node, fmt::format("{} offsets for {} cells", offsets.size(), cells));
        }
        for (std::size_t cell = 0; cell < offsets.size(); ++cell) {
            if (offsets[cell] != static_cast<std::int64_t>((cell + 1) * corners)) {
                fail(node, fmt::format("cell {} has not {} vertices", cell, corners));
            }
        }
    }

    void read_connectivity(const pugi::xml_node& node, std::size_t count, std::size_t corners) {
        const std::size_t points = soup_.points.size() - first_point_;
        Array<Index> vertices = values<Index>(node, count, [points, first = first_point_](auto value) {
            const bool inside = value >= 0 && static_cast<std::uint64_t>(value) < points;
            return inside ? static_cast<Index>(first + static_cast<std::uint64_t>(value)) : no_index;
        });
        if (vertices.size() != count) {
            fail(node,
                 fmt::format("{} vertices for {} cells of {}", vertices.size(), count / corners, corners));
        }
        const auto bad = std::find(vertices.begin(), vertices.end(), no_index);
        if (bad != vertices.end()) {
            fail(node, fmt::format("cell {} names a point that does not exist; there are {}",
                                   static_cast<std::size_t>(bad - vertices.begin()) / corners, points));
        }
        append(soup_.simplices[dimension_].vertices, std::move(vertices));
    }

    template<class Values>
    static void append(Values& all, Values&& more) {
        if (all.empty()) {
            all = std::move(more);
        } else {
            all.insert(all.end(), more.begin(), more.end());
        }
    }

    // --- data ---

    /// Every piece has the same arrays in the same order.
    void read_data(std::vector<DataArray>& arrays, const pugi::xml_node& piece, const char* section,
                   std::uint64_t rows) {
        std::size_t place = 0;
        for (const pugi::xml_node node : piece.child(section).children("DataArray")) {
            DataArray array = data_array(node, rows);
            if (is_first_piece_) {
                arrays.push_back(std::move(array));
            } else {
                join(node, arrays, place++, std::move(array));
            }
        }
        if (!is_first_piece_ && place != arrays.size()) {
            fail(piece, fmt::format("its array \"{}\" in {} is missing", arrays[place].name, section));
        }
    }

    void join(const pugi::xml_node& node, std::vector<DataArray>& arrays, std::size_t place,
              DataArray array) const {
        if (place >= arrays.size() || arrays[place].name != array.name ||
            arrays[place].components != array.components ||
            arrays[place].values.index() != array.values.index()) {
            fail(node, "the arrays of the pieces differ in name, type, components or order");
        }
        std::visit(
            [&](auto& all) {
                using Values = std::decay_t<decltype(all)>;
                append(all, std::get<Values>(std::move(array.values)));
            },
            arrays[place].values);
    }

    /// Of any number of rows where none is given.
    DataArray data_array(const pugi::xml_node& node, std::optional<std::uint64_t> rows) {
        const std::string_view type = node.attribute("type").value();
        DataArray array;
        array.name = node.attribute("Name").value();
        array.components = node.attribute("NumberOfComponents").as_int(1);
        if (array.components < 1) {
            fail(node, fmt::format("{} is no number of components", array.components));
        }
        const auto width = static_cast<std::uint64_t>(array.components);
        const std::uint64_t tuples = rows ? *rows
                                     : node.attribute("NumberOfTuples")
                                         ? count_attribute(node, "NumberOfTuples")
                                         : any_count;
        if (type == "String") {
            array.values = texts(node, any_count);
        } else if (node.attribute(text_mark)) {
            array.values = texts(node, rows ? any_count : tuples);
        } else if (type.starts_with("Float")) {
            array.values = plain<double>(node, times(tuples, width));
        } else {
            array.values = plain<std::int64_t>(node, times(tuples, width));
        }
        const std::size_t size = std::visit([](const auto& values) { return values.size(); }, array.values);
        if (size % width != 0 || (rows && size / width != *rows)) {
            fail(node, fmt::format("{} values are no {} rows of {}", size, rows.value_or(0), width));
        }
        return array;
    }

    std::vector<std::string> texts(const pugi::xml_node& node, std::uint64_t most) {
        const Stored source = stored(node, most);
        std::string characters{source.payload.bytes};
        if (source.is_text) {
            Array<char> codes;
            parse_text<std::uint8_t>(node, source.text, codes,
                                     [](auto code) { return static_cast<char>(code); });
            characters.assign(codes.begin(), codes.end());
        }
        std::vector<std::string> result;
        for (std::size_t begin = 0; begin < characters.size();) {
            const std::size_t end = std::min(characters.find('\0', begin), characters.size());
            result.push_back(characters.substr(begin, end - begin));
            begin = end + 1;
        }
        return result;
    }

    std::string_view bytes_;
    Appended appended_;
    pugi::xml_document document_;
    PayloadFormat format_;
    std::uint64_t consumed_ = 0;  ///< bytes of the file that made arrays
    std::size_t dimension_ = 0;   ///< 0 until there was a cell
    std::size_t first_point_ = 0; ///< of the piece
    bool is_first_piece_ = true;
    Soup soup_;
};

} // namespace

Soup read_vtu(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    return VtuReader{{bytes.data(), bytes.size()}, path.string()}.read();
}

} // namespace slabhull::io
