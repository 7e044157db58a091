// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "Simple Legacy Formats"; the layout of
// cells since version 5 only in the source of VTK, IO/Legacy/vtkDataReader.cxx.
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/files/percent_text.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/mixed_cells.h"
#include "io/mesh/readers.h"
#include "io/vtk/vtk_names.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace slabhull::io {

namespace {

std::string lower(std::string_view text) {
    std::string result{text};
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

/// Calls use(T{}) with the scalar type of a name; false if there is none. VTK writes its ids in 32 bits.
template<class Use>
bool with_legacy_type(const std::string& name, const Use& use) {
    const auto is = [&](auto... names) { return ((name == names) || ...); };
    const auto call = [&](auto zero) { return use(zero), true; };
    return is("double")                           ? call(double{})
           : is("float")                          ? call(float{})
           : is("int", "vtkidtype")               ? call(std::int32_t{})
           : is("long", "vtktypeint64")           ? call(std::int64_t{})
           : is("unsigned_char")                  ? call(std::uint8_t{})
           : is("char", "signed_char")            ? call(std::int8_t{})
           : is("short")                          ? call(std::int16_t{})
           : is("unsigned_short")                 ? call(std::uint16_t{})
           : is("unsigned_int")                   ? call(std::uint32_t{})
           : is("unsigned_long", "vtktypeuint64") ? call(std::uint64_t{})
                                                  : false;
}

/// The cells in the order of the file.
struct CellList {
    Array<Index> vertices;       ///< of all cells
    Array<std::uint8_t> corners; ///< number of each cell's; 255 for more
    Array<std::uint8_t> types;   ///< VTK's number for each
};

class VtkReader {
public:
    VtkReader(std::string_view bytes, const std::string& path, const ReadOptions& options)
        : in_{bytes, path}, options_{options} {
        soup_.path = path;
    }

    Soup read() {
        read_head();
        while (!in_.at_end()) {
            read_section();
        }
        in_.require(points_read_, "there is no section POINTS");
        in_.require(!cells_.corners.empty(), "there are no cells");
        in_.require(cells_.types.size() == cells_.corners.size(), "there is no section CELL_TYPES");
        sort_cells();
        return std::move(soup_);
    }

private:
    enum class Dataset { unknown, grid, surface };

    // --- head ---

    void read_head() {
        const std::string first = lower(in_.line());
        const std::string mark = "# vtk datafile version ";
        in_.require(first.starts_with(mark), "this is no VTK file: \"# vtk DataFile Version\" was expected");
        const std::string version = first.substr(mark.size());
        const int major = version.empty() || version[0] < '1' || version[0] > '9' ? 0 : version[0] - '0';
        in_.require(major >= 1 && major <= 5,
                    fmt::format("VTK file version {} is not read; save it as version 5.1 or older",
                                version.substr(0, 20)));
        cells_by_offsets_ = major >= 5;
        in_.line(); // the title
        const std::string encoding = lower(in_.word());
        in_.require(encoding == "ascii" || encoding == "binary", "ASCII or BINARY was expected");
        in_.line();
        in_.set_binary(encoding == "binary");
    }

    // --- sections ---

    void read_section() {
        const std::string name = lower(in_.word());
        if (name == "dataset") {
            read_dataset();
        } else if (name == "metadata") {
            read_metadata();
        } else if (name == "field") {
            read_field();
        } else if (name == "point_data" || name == "cell_data") {
            open_data(name == "point_data");
        } else if (rows_) {
            read_attribute(name);
        } else {
            in_.require(dataset_ != Dataset::unknown, "DATASET was expected");
            read_geometry(name);
        }
    }

    void read_dataset() {
        in_.require(dataset_ == Dataset::unknown, "DATASET appears twice");
        const std::string type = lower(in_.word());
        in_.require(type == "unstructured_grid" || type == "polydata",
                    fmt::format("a DATASET of type UNSTRUCTURED_GRID or POLYDATA was expected, not \"{}\"",
                                type.substr(0, 40)));
        dataset_ = type == "polydata" ? Dataset::surface : Dataset::grid;
    }

    void read_geometry(const std::string& name) {
        last_ = nullptr;
        const bool surface = dataset_ == Dataset::surface;
        if (name == "points") {
            read_points();
        } else if (name == "cells" && !surface) {
            in_.require(cells_.corners.empty(), "CELLS appears twice");
            read_cells();
        } else if (name == "cell_types" && !surface) {
            read_types();
        } else if (surface && (name == "vertices" || name == "lines" || name == "polygons")) {
            read_surface_cells(name == "vertices" ? 1 : name == "lines" ? 3 : 5);
        } else {
            in_.require(name != "triangle_strips", "triangle strips are not read; save them as triangles");
            in_.fail(fmt::format("\"{}\" is no section of this kind of VTK file", name.substr(0, 40)));
        }
    }

    /// Reads metadata up to a blank line. They mark arrays of bytes that are our texts.
    void read_metadata() {
        in_.line();
        std::string_view line = in_.line();
        while (!line.empty()) {
            if (line == text_mark && last_ == &soup_.field_data) {
                to_texts(last_->back());
            }
            line = in_.line();
        }
    }

    // --- values ---

    /// A checked count of rows of `width` values with `bytes` each.
    std::size_t counted(std::uint64_t rows, std::size_t width, std::size_t bytes, const char* what) const {
        return in_.plausible(rows, in_.binary() ? width * bytes : 2 * width - 1, what);
    }

    template<class S>
    S value(const char* what) {
        if (!in_.binary()) {
            return text_value<S>(what);
        }
        std::array<char, sizeof(S)> bytes;
        std::memcpy(bytes.data(), in_.take(sizeof(S), what), sizeof(S));
        if constexpr (std::endian::native == std::endian::little) { // the file is big-endian
            std::reverse(bytes.begin(), bytes.end());
        }
        return std::bit_cast<S>(bytes);
    }

    template<class S>
    S text_value(const char* what) {
        if constexpr (sizeof(S) > 1) {
            return in_.parsed<S>(what);
        } else { // a number, not a character
            const int number = in_.parsed<int>(what);
            if (!std::in_range<S>(number)) {
                in_.fail(fmt::format("{} does not fit its type", number));
            }
            return static_cast<S>(number);
        }
    }

    /// Reads `rows` rows of values of a type and converts them to T.
    template<class T>
    Array<T> values(const std::string& type, std::uint64_t rows, std::size_t width, const char* what) {
        Array<T> result;
        const bool known = with_legacy_type(type, [&](auto zero) {
            using S = decltype(zero);
            result.resize(counted(rows, width, sizeof(S), what) * width);
            for (T& one : result) {
                one = converted<T>(value<S>(what), what);
            }
        });
        in_.require(known, fmt::format("{}: the type \"{}\" is not read", what, type.substr(0, 40)));
        return result;
    }

    template<class T, class S>
    T converted(S given, const char* what) const {
        if constexpr (std::integral<T> && std::floating_point<S>) {
            in_.fail(fmt::format("{} must be of an integer type", what));
        } else if constexpr (std::integral<T>) {
            if (!std::in_range<T>(given)) {
                in_.fail(fmt::format("{}: {} is too large", what, given));
            }
        }
        return static_cast<T>(given);
    }

    // --- mesh ---

    void read_points() {
        in_.require(!points_read_, "POINTS appears twice");
        const auto claimed = in_.parsed<std::uint64_t>("the count of points");
        const std::string type = lower(in_.word());
        in_.line();
        const Array<double> x = values<double>(type, claimed, 3, "points");
        const auto bad =
            std::find_if_not(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
        in_.require(bad == x.end(), fmt::format("point {} has a coordinate that is not a finite number",
                                                (bad - x.begin()) / 3));
        soup_.points.resize(checked_index(x.size() / 3, "points"));
        if (!x.empty()) {
            std::memcpy(soup_.points.data(), x.data(), x.size() * sizeof(double));
        }
        points_read_ = true;
    }

    void read_cells() {
        in_.require(points_read_, "POINTS was expected before the cells");
        const auto first = in_.parsed<std::uint64_t>("a count of cells");
        const auto size = in_.parsed<std::uint64_t>("a count of vertices");
        in_.line();
        if (first > 0) {
            cells_by_offsets_ ? read_offset_cells(first, size) : read_counted_cells(first, size);
        }
        checked_index(cells_.corners.size(), "cells");
    }

    /// Reads cells up to version 4: the number of vertices and the vertices of each.
    void read_counted_cells(std::uint64_t claimed, std::uint64_t size) {
        const std::size_t total = counted(size, 1, sizeof(std::int32_t), "values of cells");
        in_.require(claimed <= total, fmt::format("{} cells are claimed in {} values", claimed, size));
        const auto cells = static_cast<std::size_t>(claimed);
        cells_.corners.reserve(cells_.corners.size() + cells);
        cells_.vertices.reserve(cells_.vertices.size() + total - cells);
        std::int64_t left = static_cast<std::int64_t>(total);
        for (std::size_t i = 0; i < cells; ++i) {
            const std::size_t cell = cells_.corners.size();
            const auto corners = value<std::int32_t>("a cell's number of vertices");
            if (corners < 1 || corners >= left) {
                in_.fail(fmt::format("cell {} with {} vertices goes beyond the {} values of its section",
                                     cell, corners, size));
            }
            left -= 1 + corners;
            begin_cell(corners);
            for (std::int32_t k = 0; k < corners; ++k) {
                add_vertex(value<std::int32_t>("a vertex"), cell);
            }
        }
        in_.require(left == 0, fmt::format("{} values are claimed, {} more than the cells have", size, left));
    }

    /// Reads cells since version 5: where each begins in the list of all vertices, then that list.
    void read_offset_cells(std::uint64_t offset_count, std::uint64_t size) {
        const Array<std::int64_t> offsets = cell_array("offsets", offset_count);
        const std::size_t first = cells_.corners.size();
        in_.require(offsets.front() == 0, "the first offset must be 0");
        for (std::size_t i = 1; i < offsets.size(); ++i) {
            if (offsets[i] <= offsets[i - 1]) {
                in_.fail(fmt::format("cell {} ends at offset {}, but begins at {}", first + i - 1, offsets[i],
                                     offsets[i - 1]));
            }
            begin_cell(offsets[i] - offsets[i - 1]);
        }
        in_.require(std::cmp_equal(offsets.back(), size),
                    fmt::format("the last offset is {}, but {} vertices are claimed", offsets.back(), size));
        const Array<std::int64_t> vertices = cell_array("connectivity", size);
        cells_.vertices.reserve(cells_.vertices.size() + vertices.size());
        std::size_t cell = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            cell += std::cmp_equal(i, offsets[cell + 1]) ? 1 : 0;
            add_vertex(vertices[i], first + cell);
        }
    }

    Array<std::int64_t> cell_array(const std::string& name, std::uint64_t count) {
        const std::string word = lower(in_.word());
        in_.require(word == name, fmt::format("\"{}\" was expected among the cells", name));
        const std::string type = lower(in_.word());
        in_.line();
        return values<std::int64_t>(type, count, 1, name.c_str());
    }

    void begin_cell(std::int64_t corners) {
        constexpr std::int64_t most = 255; // more than any cell type that we read has
        cells_.corners.push_back(static_cast<std::uint8_t>(std::min(corners, most)));
    }

    void add_vertex(std::int64_t vertex, std::size_t cell) {
        if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= soup_.points.size()) {
            in_.fail(fmt::format("cell {} names point {}, which does not exist; there are {}", cell, vertex,
                                 soup_.points.size()));
        }
        cells_.vertices.push_back(static_cast<Index>(vertex));
    }

    void read_types() {
        in_.require(cells_.types.empty(), "CELL_TYPES appears twice");
        const auto claimed = in_.parsed<std::uint64_t>("the count of cell types");
        in_.line();
        in_.require(claimed == cells_.corners.size(),
                    fmt::format("{} cell types for {} cells", claimed, cells_.corners.size()));
        cells_.types.reserve(cells_.corners.size());
        for (std::size_t cell = 0; cell < cells_.corners.size(); ++cell) {
            add_type(value<std::int32_t>("a cell's type"));
        }
    }

    /// Checks and adds the type of the next cell.
    void add_type(int type) {
        const std::size_t cell = cells_.types.size();
        const int dimension = vtk_simplex_dimension(type);
        if (dimension < 0) {
            in_.fail(
                fmt::format("cell {} is a {}; only vertices, lines, triangles and tetrahedra are read; mesh "
                            "with simplices, or split these cells",
                            cell, vtk_type_name(type)));
        }
        if (vtk_is_curved(type) && !options_.linear) {
            in_.fail(fmt::format("cell {} is a {}; {}", cell, vtk_type_name(type), how_to_take_corners));
        }
        if (vtk_is_curved(type) ? cells_.corners[cell] <= dimension + 1
                                : cells_.corners[cell] != dimension + 1) {
            in_.fail(
                fmt::format("cell {}, a {}, has not {} vertices", cell, vtk_type_name(type), dimension + 1));
        }
        cells_.types.push_back(static_cast<std::uint8_t>(type));
    }

    /// VTK counts cells in the order vertices, lines, polygons, whatever the order in the file.
    void read_surface_cells(int type) {
        in_.require(cells_.types.empty() || cells_.types.back() < type,
                    "VERTICES, LINES and POLYGONS were expected in this order, each once");
        read_cells();
        while (cells_.types.size() < cells_.corners.size()) {
            add_type(type);
        }
    }

    // --- data ---

    void open_data(bool on_points) {
        const auto claimed = in_.parsed<std::uint64_t>("a count of rows");
        const std::size_t rows = on_points ? soup_.points.size() : cells_.corners.size();
        in_.require(claimed == rows, fmt::format("data for {} {}, but there are {}", claimed,
                                                 on_points ? "points" : "cells", rows));
        rows_ = rows;
        arrays_ = on_points ? &soup_.point_data : &soup_.cell_data;
        last_ = nullptr;
    }

    void read_attribute(const std::string& kind) {
        if (kind == "lookup_table" || kind == "color_scalars") {
            skip_colours(kind == "lookup_table");
            return;
        }
        const std::size_t fixed = kind == "vectors" || kind == "normals" ? 3
                                  : kind == "tensors"                    ? 9
                                  : kind == "tensors6"                   ? 6
                                                                         : 1;
        const bool known = fixed > 1 || kind == "scalars" || kind == "texture_coordinates" ||
                           kind == "global_ids" || kind == "pedigree_ids" || kind == "edge_flags";
        in_.require(known, fmt::format("\"{}\" is no kind of data in a VTK file", kind.substr(0, 40)));
        const std::string name = percent_decoded(in_.word());
        const std::size_t width = kind == "texture_coordinates" ? component_count() : fixed;
        const std::string type = lower(in_.word());
        if (kind == "scalars") {
            read_scalars(name, type);
            return;
        }
        in_.line();
        add_array(*arrays_, name, type, width, *rows_);
    }

    void read_scalars(const std::string& name, const std::string& type) {
        FileCursor rest{in_.line(), soup_.path};
        const std::size_t width =
            rest.at_end() ? 1 : checked_components(rest.parsed<std::uint64_t>("a width"));
        const std::size_t start = in_.offset();
        if (lower(in_.word()) == "lookup_table") {
            in_.line();
        } else {
            in_.seek(start);
        }
        add_array(*arrays_, name, type, width, *rows_);
    }

    /// Skips colours, which a soup does not hold.
    void skip_colours(bool is_table) {
        in_.word();
        const auto claimed = in_.parsed<std::uint64_t>("a count of colours");
        in_.line();
        const std::size_t width = is_table ? 4 : checked_components(claimed);
        values<double>(in_.binary() ? "unsigned_char" : "double", is_table ? claimed : *rows_, width,
                       "colours");
        last_ = nullptr;
    }

    std::size_t component_count() { return checked_components(in_.parsed<std::uint64_t>("a width")); }

    std::size_t checked_components(std::uint64_t count) const {
        constexpr std::uint64_t most = 1000000;
        in_.require(count >= 1 && count <= most, fmt::format("{} is no number of components", count));
        return static_cast<std::size_t>(count);
    }

    void read_field() {
        in_.word(); // the name, which is not used
        const auto count = in_.parsed<std::uint64_t>("a count of arrays");
        in_.line();
        for (std::uint64_t i = 0; i < count; ++i) { // large counts fail at the end of the file
            read_field_array();
        }
    }

    void read_field_array() {
        std::string_view word = in_.word();
        while (word == "METADATA") {
            read_metadata();
            word = in_.word();
        }
        const std::string name = percent_decoded(word);
        const std::size_t width = component_count();
        const auto rows = in_.parsed<std::uint64_t>("a count of rows");
        const std::string type = lower(in_.word());
        in_.line();
        in_.require(!rows_ || rows == *rows_,
                    fmt::format("array \"{}\" has {} rows for {}", name, rows, rows_.value_or(0)));
        add_array(rows_ ? *arrays_ : soup_.field_data, name, type, width, rows);
    }

    void add_array(std::vector<DataArray>& arrays, const std::string& name, const std::string& type,
                   std::size_t width, std::uint64_t rows) {
        DataArray array{name, static_cast<int>(width), {}};
        const std::string what = fmt::format("values of array \"{}\"", name);
        if (type == "string" || type == "utf8_string") {
            array.values = read_texts(rows, width, what.c_str());
        } else if (type == "float" || type == "double") {
            array.values = values<double>(type, rows, width, what.c_str());
        } else {
            array.values = values<std::int64_t>(type, rows, width, what.c_str());
        }
        arrays.push_back(std::move(array));
        last_ = &arrays;
    }

    // --- texts ---

    std::vector<std::string> read_texts(std::uint64_t rows, std::size_t width, const char* what) {
        const std::size_t count = in_.plausible(rows, width, what) * width;
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < count; ++i) {
            if (in_.binary()) {
                const std::size_t size = in_.plausible(text_size(), 1, what);
                texts.emplace_back(in_.take(size, what), size);
            } else {
                if (in_.remaining() == 0) {
                    in_.fail(fmt::format("the file ends within {}", what));
                }
                texts.push_back(percent_decoded(in_.line()));
            }
        }
        return texts;
    }

    /// VTK's length of a text, in 1, 2, 4 or 8 bytes according to the first two bits.
    std::uint64_t text_size() {
        const auto first = value<std::uint8_t>("a text's length");
        const int bytes = 1 << (3 - (first >> 6));
        std::uint64_t size = first & 0x3F;
        for (int i = 1; i < bytes; ++i) {
            size = size << 8 | value<std::uint8_t>("a text's length");
        }
        return size;
    }

    static void to_texts(DataArray& array) {
        const auto* codes = std::get_if<IntegerList>(&array.values);
        if (codes == nullptr) {
            return;
        }
        std::vector<std::string> texts;
        std::string text;
        for (const std::int64_t code : *codes) {
            if (code == 0) {
                texts.push_back(std::exchange(text, {}));
            } else {
                text += static_cast<char>(code);
            }
        }
        if (!text.empty()) {
            texts.push_back(std::move(text));
        }
        array.components = 1;
        array.values = std::move(texts);
    }

    // --- from cells to simplices by dimension ---

    void sort_cells() {
        const std::uint8_t first = cells_.types.front();
        const bool equal = std::all_of(cells_.types.begin(), cells_.types.end(),
                                       [first](std::uint8_t type) { return type == first; });
        if (equal && !vtk_is_curved(first)) {
            block(first).vertices = std::move(cells_.vertices);
            settle_equal_cells(soup_, options_.patch_array);
            return;
        }
        const Index* vertex = cells_.vertices.data();
        for (std::size_t cell = 0; cell < cells_.types.size(); ++cell) {
            take_cell(cell, vertex);
            vertex += cells_.corners[cell];
        }
        settle_mixed_cells(soup_, options_.patch_array);
        corners_only_.finish(soup_);
    }

    void take_cell(std::size_t cell, const Index* vertices) {
        SimplexBlock& target = block(cells_.types[cell]);
        const int corners = vtk_simplex_dimension(cells_.types[cell]) + 1;
        target.vertices.insert(target.vertices.end(), vertices, vertices + corners);
        target.tags.push_back(static_cast<std::int64_t>(cell));
        for (int k = corners; k < cells_.corners[cell]; ++k) {
            corners_only_.add_between(vertices[k], soup_.points.size());
        }
        corners_only_.add_cells(vtk_is_curved(cells_.types[cell]) ? 1 : 0);
    }

    SimplexBlock& block(std::uint8_t type) {
        return soup_.simplices[static_cast<std::size_t>(vtk_simplex_dimension(type))];
    }

    FileCursor in_;
    const ReadOptions& options_;
    CornersOnly corners_only_;
    Soup soup_;
    CellList cells_;
    Dataset dataset_ = Dataset::unknown;
    bool cells_by_offsets_ = false;
    bool points_read_ = false;
    std::optional<std::size_t> rows_;          ///< rows of the data being read; empty before the first
    std::vector<DataArray>* arrays_ = nullptr; ///< destination of the arrays
    std::vector<DataArray>* last_ = nullptr;   ///< the list that ends with the array just read
};

} // namespace

Soup read_vtk(const std::filesystem::path& path) {
    return read_vtk(path, ReadOptions{});
}

Soup read_vtk(const std::filesystem::path& path, const ReadOptions& options) {
    const Array<char> bytes = read_bytes(path);
    return VtkReader{{bytes.data(), bytes.size()}, path.string(), options}.read();
}

} // namespace slabhull::io
