// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "XML File Formats".
#include "slabhull/io/files.h"

#include "base64.h"
#include "file_cursor.h"
#include "vtk_names.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <pugixml.hpp>

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
    std::string_view bytes;
    Array<char> decoded; ///< owns the bytes where they were base64
    bool is_text = false;
};

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
            add_data(soup_.field_data, node, 0);
        }
        const pugi::xml_node piece = grid.child("Piece");
        if (!piece || piece.next_sibling("Piece")) {
            fail(grid, "exactly one Piece was expected");
        }
        read_points(piece);
        read_cells(piece);
        read_data(soup_.point_data, piece.child("PointData"), soup_.points.size());
        read_data(soup_.cell_data, piece.child("CellData"), cells_);
        return std::move(soup_);
    }

private:
    [[noreturn]] void fail_at(std::ptrdiff_t byte, const std::string& text) const {
        throw InputError(fmt::format("{}: byte {}: {}", soup_.path, byte, text), {Entity{"byte", byte, {}}});
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
        if (std::string_view{file.attribute("byte_order").as_string("LittleEndian")} != "LittleEndian") {
            fail(file, "big-endian files are not read; save it in little-endian order");
        }
        if (*file.attribute("compressor").value() != '\0') {
            fail(file, "compressed files are not read; save it without compression");
        }
        wide_header_ = std::string_view{file.attribute("header_type").value()} == "UInt64";
        return file.child("UnstructuredGrid");
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

    Stored stored(const pugi::xml_node& node) const {
        const std::string_view format = node.attribute("format").as_string("ascii");
        if (format == "ascii") {
            return {node.text().get(), {}, true};
        }
        if (format == "binary") {
            std::string_view text = node.text().get();
            text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
            return base64(node, text);
        }
        if (format != "appended") {
            fail(node, fmt::format("the format \"{}\" is not known", format));
        }
        const std::uint64_t offset = count_attribute(node, "offset");
        if (offset > appended_.data.size()) {
            fail(node, fmt::format("offset {} lies beyond the end of the file", offset));
        }
        const std::string_view data = appended_.data.substr(offset);
        return appended_.is_base64 ? base64(node, data) : raw(node, data);
    }

    std::size_t header_size() const { return wide_header_ ? sizeof(std::uint64_t) : sizeof(std::uint32_t); }

    /// Number of bytes that the header tells.
    std::uint64_t byte_count(const char* header) const {
        std::uint64_t count = 0; // little-endian, so that the shorter one fills its lower half
        std::memcpy(&count, header, header_size());
        return count;
    }

    Stored raw(const pugi::xml_node& node, std::string_view data) const {
        if (data.size() < header_size() || byte_count(data.data()) > data.size() - header_size()) {
            fail(node, "its data reach beyond the end of the file");
        }
        return {data.substr(header_size(), byte_count(data.data())), {}, false};
    }

    Stored base64(const pugi::xml_node& node, std::string_view text) const {
        const auto header = decode_base64(text, header_size());
        const std::uint64_t count = header ? byte_count(header->data()) : 0;
        auto decoded =
            header && count < text.size() ? decode_base64(text, header_size() + count) : std::nullopt;
        if (!decoded) {
            fail(node, "its base64 data are cut short or damaged");
        }
        Stored result;
        result.decoded = std::move(*decoded);
        result.bytes = std::string_view{result.decoded.data(), result.decoded.size()}.substr(header_size());
        return result;
    }

    /// All values as T, each by convert(value) from the type in the file.
    template<class T, class Convert>
    Array<T> values(const pugi::xml_node& node, const Convert& convert) const {
        Array<T> result;
        const Stored source = stored(node);
        const bool known = with_vtk_type(node.attribute("type").value(), [&](auto zero) {
            using S = decltype(zero);
            if (source.is_text) {
                parse_text<S>(node, source.bytes, result, convert);
                return;
            }
            if (source.bytes.size() % sizeof(S) != 0) {
                fail(node, fmt::format("{} bytes are no whole number of values", source.bytes.size()));
            }
            result.resize(source.bytes.size() / sizeof(S));
            for (std::size_t i = 0; i < result.size(); ++i) {
                S value;
                std::memcpy(&value, source.bytes.data() + i * sizeof(S), sizeof(S));
                result[i] = convert(value);
            }
        });
        if (!known) {
            fail(node, fmt::format("the type \"{}\" is not read", node.attribute("type").value()));
        }
        return result;
    }

    template<class S, class T, class Convert>
    void parse_text(const pugi::xml_node& node, std::string_view text, Array<T>& result,
                    const Convert& convert) const {
        FileCursor cursor{text, fmt::format("{}: array \"{}\"", soup_.path, node.attribute("Name").value())};
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
    Array<T> plain(const pugi::xml_node& node) const {
        return values<T>(node, [](auto value) { return static_cast<T>(value); });
    }

    // --- mesh ---

    void read_points(const pugi::xml_node& piece) {
        const pugi::xml_node node = piece.child("Points").child("DataArray");
        const std::uint64_t count = count_attribute(piece, "NumberOfPoints");
        const Array<double> x = plain<double>(node);
        if (x.size() % 3 != 0 || x.size() / 3 != count) {
            fail(node, fmt::format("{} values are no {} points of 3 coordinates", x.size(), count));
        }
        checked_index(x.size() / 3, "points");
        const auto bad =
            std::find_if_not(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
        if (bad != x.end()) {
            fail(node,
                 fmt::format("point {} has a coordinate that is not a finite number", (bad - x.begin()) / 3));
        }
        soup_.points.resize(x.size() / 3);
        if (!x.empty()) {
            std::memcpy(soup_.points.data(), x.data(), x.size() * sizeof(double));
        }
    }

    void read_cells(const pugi::xml_node& piece) {
        const pugi::xml_node section = piece.child("Cells");
        const auto array = [&](const char* name) {
            const pugi::xml_node node = section.find_child_by_attribute("DataArray", "Name", name);
            if (!node) {
                fail(piece, fmt::format("the array \"{}\" is missing", name));
            }
            return node;
        };
        const std::size_t dimension = cell_dimension(piece, array("types"));
        check_offsets(array("offsets"), dimension + 1);
        read_connectivity(array("connectivity"), dimension);
    }

    /// Also counts the cells.
    std::size_t cell_dimension(const pugi::xml_node& piece, const pugi::xml_node& node) {
        const Array<std::int64_t> types = plain<std::int64_t>(node);
        const std::uint64_t claimed = count_attribute(piece, "NumberOfCells");
        if (types.size() != claimed || types.empty()) {
            fail(node, types.empty()
                           ? "there are no cells"
                           : fmt::format("{} cells are claimed, {} types are there", claimed, types.size()));
        }
        cells_ = checked_index(types.size(), "cells");
        int dimension = 3;
        while (dimension > 1 && types.front() != vtk_simplex_type(dimension)) {
            --dimension;
        }
        const auto other = std::find_if(types.begin(), types.end(), [&](std::int64_t type) {
            return type != vtk_simplex_type(dimension);
        });
        if (other != types.end()) {
            fail(node, fmt::format("cell {} is a {}; only lines, only triangles or only tetrahedra are read",
                                   other - types.begin(), vtk_type_name(static_cast<int>(*other & 0xFF))));
        }
        return static_cast<std::size_t>(dimension);
    }

    void check_offsets(const pugi::xml_node& node, std::size_t corners) const {
        const Array<std::int64_t> offsets = plain<std::int64_t>(node);
        if (offsets.size() != cells_) {
            fail(node, fmt::format("{} offsets for {} cells", offsets.size(), cells_));
        }
        for (std::size_t cell = 0; cell < offsets.size(); ++cell) {
            if (offsets[cell] != static_cast<std::int64_t>((cell + 1) * corners)) {
                fail(node, fmt::format("cell {} has not {} vertices", cell, corners));
            }
        }
    }

    void read_connectivity(const pugi::xml_node& node, std::size_t dimension) {
        const std::size_t corners = dimension + 1;
        const std::size_t points = soup_.points.size();
        Array<Index>& vertices = soup_.simplices[dimension].vertices;
        vertices = values<Index>(node, [points](auto value) {
            const bool inside = value >= 0 && static_cast<std::uint64_t>(value) < points;
            return inside ? static_cast<Index>(value) : no_index;
        });
        if (vertices.size() != cells_ * corners) {
            fail(node, fmt::format("{} vertices for {} cells of {}", vertices.size(), cells_, corners));
        }
        const auto bad = std::find(vertices.begin(), vertices.end(), no_index);
        if (bad != vertices.end()) {
            fail(node, fmt::format("cell {} names a point that does not exist; there are {}",
                                   static_cast<std::size_t>(bad - vertices.begin()) / corners, points));
        }
    }

    // --- data ---

    void read_data(std::vector<DataArray>& arrays, const pugi::xml_node& section, std::size_t rows) {
        for (const pugi::xml_node node : section.children("DataArray")) {
            add_data(arrays, node, rows);
        }
    }

    /// `rows` is 0 where any number will do.
    void add_data(std::vector<DataArray>& arrays, const pugi::xml_node& node, std::size_t rows) {
        const std::string_view type = node.attribute("type").value();
        DataArray array;
        array.name = node.attribute("Name").value();
        if (type == "String" || node.attribute(text_mark)) {
            array.values = texts(node);
            arrays.push_back(std::move(array));
            return;
        }
        std::size_t size = 0;
        if (type.starts_with("Float")) {
            array.values = plain<double>(node);
            size = std::get<Array<double>>(array.values).size();
        } else {
            array.values = plain<std::int64_t>(node);
            size = std::get<Array<std::int64_t>>(array.values).size();
        }
        array.components = node.attribute("NumberOfComponents").as_int(1);
        const auto width = static_cast<std::size_t>(std::max(1, array.components));
        if (array.components < 1 || size % width != 0 || (rows > 0 && size / width != rows)) {
            fail(node, fmt::format("{} values are no {} rows of {}", size, rows, array.components));
        }
        arrays.push_back(std::move(array));
    }

    std::vector<std::string> texts(const pugi::xml_node& node) const {
        const Stored source = stored(node);
        std::string characters{source.bytes};
        if (source.is_text) {
            Array<char> codes;
            parse_text<std::uint8_t>(node, source.bytes, codes,
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
    bool wide_header_ = false;
    std::size_t cells_ = 0;
    Soup soup_;
};

} // namespace

Soup read_vtu(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    return VtuReader{{bytes.data(), bytes.size()}, path.string()}.read();
}

} // namespace slabhull::io
