// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "XDMF Model and Format" (xdmf.org), versions 2 and 3.
#include "slabhull/io/files.h"

#include "io/files/byte_order.h"
#include "io/files/file_cursor.h"
#include "io/files/utf8.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/mixed_cells.h"
#include "io/mesh/readers.h"
#include "io/vtk/vtk_names.h"
#include "io/xdmf/hdf5_file.h"
#include "io/xdmf/xdmf_names.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <numeric>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <utility>

namespace slabhull::io {

namespace {

constexpr std::uint64_t most_count = std::numeric_limits<std::uint64_t>::max();

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

bool same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// A DataItem, wherever its values are stored, before they are read.
struct Item {
    pugi::xml_node node;
    std::vector<std::uint64_t> extents;
    std::uint64_t count = 1;
    std::string type;      ///< VTK's name, for text and bytes
    std::string_view text; ///< the values as text ..
    Array<char> bytes;     ///< .. or as bytes, and their order ..
    bool swapped = false;
    std::optional<Hdf5Dataset> dataset; ///< .. or in HDF5

    bool reals() const { return dataset ? dataset->has_reals() : type.starts_with("Float"); }
};

class XdmfReader {
public:
    XdmfReader(const Array<char>& bytes, const std::filesystem::path& path, const ReadOptions& options)
        : options_{options}, folder_{std::filesystem::weakly_canonical(path).parent_path()} {
        soup_.path = path.string();
        const pugi::xml_parse_result result =
            document_.load_buffer(bytes.data(), bytes.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!result) {
            fail_at(result.offset, fmt::format("this is no XDMF file: {}", result.description()));
        }
    }

    Soup read() {
        const pugi::xml_node grid = find_grid();
        read_points(only_child(grid, "Geometry"));
        read_cells(only_child(grid, "Topology"));
        for (const pugi::xml_node node : grid.children("Attribute")) {
            read_attribute(node);
        }
        for (const pugi::xml_node node : grid.children("Information")) {
            if (std::string_view{node.attribute("Name").value()} == xdmf_fields) {
                read_fields(node);
            }
        }
        if (soup_.simplices[static_cast<std::size_t>(soup_.top_dimension())].tags.empty()) {
            settle_equal_cells(soup_, options_.patch_array);
        } else {
            settle_mixed_cells(soup_, options_.patch_array);
        }
        corners_only_.finish(soup_);
        return std::move(soup_);
    }

private:
    [[noreturn]] void fail_at(std::ptrdiff_t byte, const std::string& text) const {
        throw InputError(fmt::format("{}: byte {}: {}", soup_.path, byte, readable(text)),
                         {Entity{"byte", byte, {}}});
    }
    [[noreturn]] void fail(const pugi::xml_node& node, const std::string& text) const {
        const pugi::xml_node named =
            std::string_view{node.name()} == "DataItem" && node.parent() ? node.parent() : node;
        const std::string name = named.attribute("Name").value();
        fail_at(node.offset_debug(),
                fmt::format("{}{}: {}", named.name(), name.empty() ? "" : " \"" + name + "\"", text));
    }

    // --- XML

    pugi::xml_node only_child(const pugi::xml_node& node, const char* name) const {
        const pugi::xml_node child = node.child(name);
        if (!child) {
            fail(node, fmt::format("its {} is missing", name));
        }
        if (child.next_sibling(name)) {
            fail(node, fmt::format("it has more than one {}; save each in a file of its own", name));
        }
        return child;
    }

    /// The only grid, perhaps within collections of one.
    pugi::xml_node find_grid() const {
        const pugi::xml_node root = document_.child("Xdmf");
        if (!root) {
            fail_at(0, "an element Xdmf was expected");
        }
        pugi::xml_node grid = only_child(only_child(root, "Domain"), "Grid");
        while (grid.child("Grid")) {
            grid = only_child(grid, "Grid");
        }
        return grid;
    }

    /// The type of an element. Versions 2 and 3 name the attribute differently, and files mix both.
    std::string_view type_of(const pugi::xml_node& node, const char* long_name) const {
        const pugi::xml_attribute type = node.attribute(long_name);
        return (type ? type : node.attribute("Type")).value();
    }

    std::uint64_t parsed_count(const pugi::xml_node& node, std::string_view text) const {
        std::uint64_t value = 0;
        const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (problem != std::errc{} || stop != text.data() + text.size()) {
            fail(node, fmt::format("\"{}\" is no count", text.substr(0, 40)));
        }
        return value;
    }

    // --- arrays

    Item item_of(const pugi::xml_node& parent) {
        Item item;
        item.node = only_child(parent, "DataItem");
        const std::string_view kind = item.node.attribute("ItemType").as_string("Uniform");
        if (!same_word(kind, "Uniform") || item.node.attribute("Reference")) {
            fail(item.node, "only plain DataItems are read, not references, functions or parts of others");
        }
        find_extents(item);
        item.type = type_name(item.node);
        const std::string_view format = item.node.attribute("Format").as_string("XML");
        if (same_word(format, "XML")) {
            open_text(item);
        } else if (same_word(format, "HDF")) {
            open_dataset(item);
        } else if (same_word(format, "Binary")) {
            open_bytes(item);
        } else {
            fail(item.node, fmt::format("the format \"{}\" is not read", format));
        }
        return item;
    }

    void find_extents(Item& item) const {
        std::string_view text = trimmed(item.node.attribute("Dimensions").value());
        if (text.empty()) {
            fail(item.node, "its Dimensions are missing");
        }
        while (!text.empty()) {
            const auto blank = std::find_if(text.begin(), text.end(), is_blank);
            const auto size = static_cast<std::size_t>(blank - text.begin());
            const std::uint64_t extent = parsed_count(item.node, text.substr(0, size));
            if (extent > 0 && item.count > most_count / extent) {
                fail(item.node, "its Dimensions are too large");
            }
            item.count *= extent;
            item.extents.push_back(extent);
            text = trimmed(text.substr(size));
        }
    }

    /// "Int64" for Int of 8 bytes.
    std::string type_name(const pugi::xml_node& node) const {
        const pugi::xml_attribute given = node.attribute("NumberType");
        const std::string_view type = (given ? given : node.attribute("DataType")).as_string("Float");
        const bool is_char = same_word(type, "Char") || same_word(type, "UChar");
        const std::uint64_t bytes =
            is_char ? 1 : parsed_count(node, node.attribute("Precision").as_string("4"));
        const char* name = same_word(type, "Float")                              ? "Float"
                           : same_word(type, "Int") || same_word(type, "Char")   ? "Int"
                           : same_word(type, "UInt") || same_word(type, "UChar") ? "UInt"
                                                                                 : nullptr;
        if (name == nullptr || bytes > sizeof(std::int64_t)) {
            fail(node, fmt::format("numbers of type {} with {} bytes are not read", type, bytes));
        }
        return fmt::format("{}{}", name, 8 * bytes);
    }

    void open_text(Item& item) const {
        item.text = item.node.text().get();
        if (item.count > item.text.size() / 2 + 1) {
            fail(item.node, fmt::format("{} values are claimed, but only {} characters follow", item.count,
                                        item.text.size()));
        }
    }

    void open_dataset(Item& item) {
        const std::string_view place = trimmed(item.node.text().get());
        const std::size_t colon = place.rfind(':');
        if (colon == std::string_view::npos || colon == 0 || colon + 1 == place.size()) {
            fail(item.node, fmt::format("FILE.h5:/dataset was expected, not \"{}\"", place.substr(0, 40)));
        }
        const std::string file{place.substr(0, colon)};
        auto reader = readers_.find(file);
        if (reader == readers_.end()) {
            reader = readers_.emplace(file, Hdf5Reader{folder_ / file}).first;
        }
        item.dataset.emplace(reader->second.open(std::string{place.substr(colon + 1)}));
        const std::vector<std::uint64_t>& held = item.dataset->extents();
        const auto product = [](std::uint64_t a, std::uint64_t b) { return a * b; };
        if (std::accumulate(held.begin(), held.end(), std::uint64_t{1}, product) != item.count) {
            fail(item.node, fmt::format("{} values are claimed, but {} has {}", item.count, place,
                                        fmt::join(held, " x ")));
        }
    }

    void open_bytes(Item& item) const {
        const std::string_view order = item.node.attribute("Endian").as_string("Native");
        const std::string_view packed = item.node.attribute("Compression").as_string("Raw");
        if (!same_word(packed, "Raw") || item.node.attribute("Seek").as_ullong() > 0) {
            fail(item.node, "binary files are read only plain and from their beginning");
        }
        const std::string_view other = std::endian::native == std::endian::little ? "Big" : "Little";
        item.swapped = same_word(order, other);
        item.bytes = read_bytes(folder_ / std::string{trimmed(item.node.text().get())});
        with_vtk_type(item.type, [&](auto zero) {
            if (item.bytes.size() % sizeof zero != 0 || item.bytes.size() / sizeof zero != item.count) {
                fail(item.node,
                     fmt::format("{} values of {} bytes are claimed, but {} has {} bytes", item.count,
                                 sizeof zero, trimmed(item.node.text().get()), item.bytes.size()));
            }
        });
    }

    /// Reads all values: rows of `used` numbers into rows of `width`.
    template<class T>
    void take(const Item& item, T* out, std::size_t used, std::size_t width) const {
        const auto rows = static_cast<std::size_t>(item.count / used);
        if (item.dataset) {
            item.dataset->read(out, rows, used, width);
            return;
        }
        const bool known = with_vtk_type(item.type, [&](auto zero) {
            using Given = decltype(zero);
            FileCursor text{item.text, fmt::format("{}: {}", soup_.path, item.node.parent().name())};
            const char* bytes = item.bytes.data();
            for (std::size_t i = 0; i < item.count; ++i) {
                T& place = out[i / used * width + i % used];
                if (item.bytes.empty()) {
                    place = parsed<Given, T>(item, text);
                } else {
                    place = converted<T>(item, load<Given>(bytes + i * sizeof(Given), item.swapped));
                }
            }
            text.require(text.at_end(), "there are more values than the Dimensions say");
        });
        if (!known) {
            fail(item.node, fmt::format("numbers of type {} are not read", item.type));
        }
    }

    template<class Stored, class T>
    T parsed(const Item& item, FileCursor& text) const {
        if constexpr (sizeof(Stored) == 1) { // a number, not a character
            return converted<T>(item, text.parsed<int>("a number"));
        } else {
            return converted<T>(item, text.parsed<Stored>("a number"));
        }
    }

    template<class T, class Stored>
    T converted(const Item& item, Stored value) const {
        if constexpr (std::is_integral_v<T> && std::is_integral_v<Stored>) {
            if (!std::in_range<T>(value)) {
                fail(item.node, fmt::format("the number {} is negative or too large", value));
            }
        }
        return static_cast<T>(value);
    }

    // --- mesh

    void read_points(const pugi::xml_node& node) {
        const std::string_view type = type_of(node, "GeometryType");
        const bool planar = same_word(type, "XY");
        if (!planar && !type.empty() && !same_word(type, "XYZ")) {
            fail(node, fmt::format("a geometry XYZ or XY was expected, not {}", type));
        }
        const std::size_t used = planar ? 2 : 3;
        const Item item = item_of(node);
        if (item.count % used != 0) {
            fail(item.node, fmt::format("{} values are no points of {} coordinates", item.count, used));
        }
        const std::size_t count = checked_index(item.count / used, "points");
        soup_.points.resize(count);
        if (planar) {
            std::fill(soup_.points.begin(), soup_.points.end(), Point<3>{});
        }
        take(item, reinterpret_cast<double*>(soup_.points.data()), used, 3);
        const auto bad = std::find_if_not(soup_.points.begin(), soup_.points.end(), [](const Point<3>& x) {
            return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
        });
        if (bad != soup_.points.end()) {
            fail(item.node, fmt::format("point {} has a coordinate that is not a finite number",
                                        bad - soup_.points.begin()));
        }
    }

    void read_cells(const pugi::xml_node& node) {
        const std::string_view type = type_of(node, "TopologyType");
        if (node.attribute("BaseOffset").as_int() != 0) {
            fail(node, "points are counted from 0 only");
        }
        const Item item = item_of(node);
        if (item.reals()) {
            fail(item.node, "its numbers of points are no integers");
        }
        if (same_word(type, "Mixed")) {
            read_mixed_cells(node, item);
        } else if (const auto curved = curved_topology(type)) {
            read_curved_cells(node, item, *curved);
        } else {
            read_equal_cells(node, item, dimension_named(node, type));
        }
        if (soup_.top_dimension() == 0 && soup_.simplices[0].vertices.empty()) {
            fail(node, "there are no cells");
        }
        const pugi::xml_attribute claimed = node.attribute("NumberOfElements");
        if (claimed && parsed_count(node, trimmed(claimed.value())) != cells_) {
            fail(node, fmt::format("{} cells are claimed, but there are {}", claimed.value(), cells_));
        }
    }

    std::size_t dimension_named(const pugi::xml_node& node, std::string_view type) const {
        const auto found = std::find_if(xdmf_topologies.begin(), xdmf_topologies.end(),
                                        [&](const char* name) { return same_word(name, type); });
        if (found == xdmf_topologies.end()) {
            fail(node,
                 fmt::format("cells {} are not read, only simplices: polyvertex, polyline of two points, "
                             "triangle, tetrahedron or mixed",
                             type));
        }
        return static_cast<std::size_t>(found - xdmf_topologies.begin());
    }

    void read_equal_cells(const pugi::xml_node& node, const Item& item, std::size_t dimension) {
        const std::size_t corners = dimension + 1;
        const pugi::xml_attribute claimed = node.attribute("NodesPerElement");
        const bool other_width = item.extents.size() > 1 && item.extents.back() != corners;
        if (item.count % corners != 0 || other_width || (claimed && claimed.as_ullong() != corners)) {
            fail(item.node, fmt::format("a {} has {} points here", type_of(node, "TopologyType"), corners));
        }
        cells_ = checked_index(item.count / corners, "cells");
        Array<Index>& vertices = soup_.simplices[dimension].vertices;
        vertices.resize(item.count);
        take(item, vertices.data(), corners, corners);
        const auto bad = std::find_if(vertices.begin(), vertices.end(),
                                      [&](Index vertex) { return vertex >= soup_.points.size(); });
        if (bad != vertices.end()) {
            refuse_vertex(item.node, static_cast<std::size_t>(bad - vertices.begin()) / corners, *bad);
        }
    }

    struct Curved {
        std::size_t dimension;
        std::size_t nodes; ///< nodes per cell, corners first
    };

    static std::optional<Curved> curved_topology(std::string_view type) {
        const auto is = [type](const char* a, const char* b) {
            return same_word(a, type) || same_word(b, type);
        };
        if (is("Edge_3", "Edge3")) {
            return Curved{1, 3};
        }
        if (is("Triangle_6", "Tri_6")) {
            return Curved{2, 6};
        }
        if (is("Tetrahedron_10", "Tet_10")) {
            return Curved{3, 10};
        }
        return std::nullopt;
    }

    void read_curved_cells(const pugi::xml_node& node, const Item& item, const Curved& curved) {
        if (!options_.linear) {
            fail(node, fmt::format("cells {} are of second order; {}", type_of(node, "TopologyType"),
                                   how_to_take_corners));
        }
        if (item.count % curved.nodes != 0) {
            fail(item.node, fmt::format("a {} has {} points", type_of(node, "TopologyType"), curved.nodes));
        }
        cells_ = checked_index(item.count / curved.nodes, "cells");
        Array<std::int64_t> points(item.count);
        take(item, points.data(), curved.nodes, curved.nodes);
        Array<Index>& vertices = soup_.simplices[curved.dimension].vertices;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (points[i] < 0 || std::cmp_greater_equal(points[i], soup_.points.size())) {
                refuse_vertex(item.node, i / curved.nodes, points[i]);
            }
            const auto point = static_cast<Index>(points[i]);
            if (i % curved.nodes <= curved.dimension) {
                vertices.push_back(point);
            } else {
                corners_only_.add_between(point, soup_.points.size());
            }
        }
        corners_only_.add_cells(cells_);
    }

    [[noreturn]] void refuse_vertex(const pugi::xml_node& node, std::size_t cell, std::int64_t vertex) const {
        fail(node, fmt::format("cell {} names point {}; there are {}, counted from 0", cell, vertex,
                               soup_.points.size()));
    }

    /// Each cell is the number of its kind, then, for lines and points, the number of its points, then the
    /// points.
    void read_mixed_cells(const pugi::xml_node& node, const Item& item) {
        checked_index(item.count, "numbers of points");
        Array<std::int64_t> numbers(item.count);
        take(item, numbers.data(), 1, 1);
        for (std::size_t at = 0; at < numbers.size(); ++cells_) {
            const auto kind = std::find(xdmf_numbers.begin(), xdmf_numbers.end(), numbers[at]);
            if (kind == xdmf_numbers.end()) {
                fail(node, fmt::format("cell {} is of kind {}, which is no simplex", cells_, numbers[at]));
            }
            const auto dimension = static_cast<std::size_t>(kind - xdmf_numbers.begin());
            const std::size_t corners = dimension + 1;
            const bool counted = dimension < 2;
            const std::size_t begin = at + (counted ? 2 : 1);
            if (begin + corners > numbers.size() ||
                (counted && numbers[at + 1] != static_cast<std::int64_t>(corners))) {
                fail(node, fmt::format("cell {}, a {}, has not {} points", cells_, xdmf_topologies[dimension],
                                       corners));
            }
            add_cell(item.node, dimension, std::span{numbers}.subspan(begin, corners));
            at = begin + corners;
        }
    }

    /// Adds a cell with its number in the file as its tag, by which cell data are ordered.
    void add_cell(const pugi::xml_node& node, std::size_t dimension, std::span<const std::int64_t> vertices) {
        SimplexBlock& block = soup_.simplices[dimension];
        for (const std::int64_t vertex : vertices) {
            if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= soup_.points.size()) {
                refuse_vertex(node, cells_, vertex);
            }
            block.vertices.push_back(static_cast<Index>(vertex));
        }
        block.tags.push_back(static_cast<std::int64_t>(cells_));
    }

    // --- data

    void read_attribute(const pugi::xml_node& node) {
        const std::string_view center = node.attribute("Center").as_string("Node");
        if (same_word(center, "Node")) {
            if (!is_our_space_time(node)) {
                soup_.point_data.push_back(data_array(node, soup_.points.size()));
            }
        } else if (same_word(center, "Cell")) {
            soup_.cell_data.push_back(data_array(node, cells_));
        } else if (same_word(center, "Grid")) {
            soup_.field_data.push_back(data_array(node, std::nullopt));
        } else {
            fail(node, fmt::format("data over each {} are not read", center));
        }
    }

    /// Whether an attribute is the one that our writer adds, repeating points and times.
    bool is_our_space_time(const pugi::xml_node& node) const {
        return std::string_view{node.attribute("Name").value()} == xdmf_space_time &&
               trimmed(node.child("DataItem").text().get()).ends_with(fmt::format(":/{}", xdmf_space_time));
    }

    void read_fields(const pugi::xml_node& list) {
        for (const pugi::xml_node node : list.children("Information")) {
            soup_.field_data.push_back(data_array(node, std::nullopt));
        }
    }

    /// The array of an element; of any number of rows if none is given.
    DataArray data_array(const pugi::xml_node& node, std::optional<std::size_t> rows) {
        DataArray array;
        array.name = as_utf8(node.attribute("Name").value());
        const Item item = item_of(node);
        const auto width = static_cast<std::size_t>(width_of(node, item, rows));
        array.components = static_cast<int>(width);
        if (std::string_view{node.attribute("Value").value()} == xdmf_texts) {
            array.values = texts(item);
        } else if (item.reals()) {
            array.values.emplace<Array<double>>(item.count);
            take(item, std::get<Array<double>>(array.values).data(), width, width);
        } else {
            Array<std::int64_t> numbers(item.count);
            take(item, numbers.data(), width, width);
            array.values = IntegerList{std::move(numbers)};
        }
        return array;
    }

    /// Components of a row: the product of the extents after the first or, if there is only one, by the
    /// attribute's type.
    std::uint64_t width_of(const pugi::xml_node& node, const Item& item,
                           std::optional<std::size_t> rows) const {
        std::uint64_t width = 1;
        for (std::size_t i = 1; i < item.extents.size(); ++i) {
            width *= item.extents[i];
        }
        if (item.extents.size() == 1 && rows) {
            const std::string_view type = type_of(node, "AttributeType");
            width = same_word(type, "Vector")    ? 3
                    : same_word(type, "Tensor")  ? 9
                    : same_word(type, "Tensor6") ? 6
                                                 : 1;
        }
        constexpr std::uint64_t most = std::numeric_limits<int>::max();
        if (width == 0 || width > most || item.count % width != 0 || (rows && item.count / width != *rows)) {
            fail(item.node, fmt::format("Dimensions {} do not fit {} rows", fmt::join(item.extents, " "),
                                        rows.value_or(0)));
        }
        return width;
    }

    std::vector<std::string> texts(const Item& item) const {
        Array<std::int64_t> codes(item.count);
        take(item, codes.data(), 1, 1);
        std::vector<std::string> result;
        bool open = false;
        for (const std::int64_t code : codes) {
            if (!open) {
                result.emplace_back();
            }
            open = code != 0;
            if (open) {
                result.back() += static_cast<char>(code);
            }
        }
        return result;
    }

    const ReadOptions& options_;
    CornersOnly corners_only_;
    std::filesystem::path folder_;
    pugi::xml_document document_;
    std::map<std::string, Hdf5Reader> readers_;
    std::size_t cells_ = 0; ///< of all dimensions
    Soup soup_;
};

} // namespace

Soup read_xdmf(const std::filesystem::path& path) {
    return read_xdmf(path, ReadOptions{});
}

Soup read_xdmf(const std::filesystem::path& path, const ReadOptions& options) {
    return XdmfReader{read_bytes(path), path, options}.read();
}

} // namespace slabhull::io
