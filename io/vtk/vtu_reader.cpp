// SPDX-License-Identifier: BSD-3-Clause
// The format is described in "VTK File Formats" (Kitware), section "XML File Formats".
#include "slabhull/io/files.h"

#include "io/files/byte_order.h"
#include "io/files/file_cursor.h"
#include "io/files/utf8.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/mixed_cells.h"
#include "io/mesh/readers.h"
#include "io/vtk/vtk_names.h"
#include "io/vtk/vtu_payload.h"
#include "io/vtk/vtu_pieces.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <fmt/format.h>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <utility>
#include <vector>

namespace slabhull::io {

namespace {

/// An array's values in the file: bytes, or text.
struct Stored {
    FileRange range;
    bool is_text = false;
    bool is_base64 = false;
};

constexpr std::uint64_t any_count = std::numeric_limits<std::uint64_t>::max();

/// The product, or the largest number if it overflows.
std::uint64_t times(std::uint64_t a, std::uint64_t b) {
    return b > 0 && a > any_count / b ? any_count : a * b;
}

class VtuReader {
public:
    VtuReader(FileBytes& file, const ReadOptions& options) : file_{file}, skeleton_{file}, options_{options} {
        soup_.path = file.path().string();
    }

    Soup read(bool may_be_empty) {
        parse_xml();
        const pugi::xml_node grid = open_grid();
        for (const pugi::xml_node node : grid.child("FieldData").children()) {
            soup_.field_data.push_back(field_array(node));
        }
        count_all(grid);
        for (const pugi::xml_node piece : grid.children("Piece")) {
            read_piece(piece);
        }
        if (soup_.top_dimension() == 0 && !(may_be_empty && soup_.points.empty())) {
            fail(grid, "there are no cells but points");
        }
        if (is_mixed_) {
            settle_mixed_cells(soup_, options_.patch_array);
        } else {
            settle_equal_cells(soup_, options_.patch_array);
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
        const std::string name = node.attribute("Name").value();
        const std::string what = name.empty() ? node.name() : "array \"" + name + "\"";
        fail_at(skeleton_.in_file(node.offset_debug()), fmt::format("{}: {}", what, text));
    }

    // --- XML ---

    void parse_xml() {
        std::string& xml = skeleton_.xml();
        const pugi::xml_parse_result result =
            document_.load_buffer_inplace(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!result) {
            fail_at(skeleton_.in_file(result.offset),
                    fmt::format("this is no VTU file: {}", result.description()));
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

    Stored stored(const pugi::xml_node& node) const {
        const std::string_view format = node.attribute("format").as_string("ascii");
        if (format == "ascii" || format == "binary") {
            return {skeleton_.text(node.text().data().offset_debug()), format == "ascii", true};
        }
        if (format != "appended") {
            fail(node, fmt::format("the format \"{}\" is not known", format));
        }
        FileRange range = skeleton_.appended();
        const std::uint64_t offset = count_attribute(node, "offset");
        if (offset > range.end - range.begin) {
            fail(node, fmt::format("offset {} lies beyond the end of the file", offset));
        }
        range.begin += offset;
        return {range, false, skeleton_.appended_is_base64()};
    }

    using Start = std::function<void(std::uint64_t count)>;
    template<class S>
    using Take = std::function<void(std::uint64_t first, std::span<const S> values)>;

    /// Reads all values of an array of a type. start(n) throws if n values are not expected, else returns
    /// their place. Then each(place, i, value) is called for all values, from several threads, but for the
    /// first value before all others. Packed arrays of more than `count` values are refused; any_count: any
    /// number is allowed.
    template<class PlaceOf, class Each>
    void values(const pugi::xml_node& node, std::string_view type, std::uint64_t count, const PlaceOf& start,
                const Each& each) {
        decltype(start(0)) place{};
        const bool known = with_vtk_type(type, [&](auto zero) {
            using S = decltype(zero);
            read_values<S>(
                node, count, [&](std::uint64_t given) { place = start(given); },
                [&](std::uint64_t first, std::span<const S> given) {
                    for (std::size_t i = 0; i < given.size(); ++i) {
                        each(place, first + i, given[i]);
                    }
                });
        });
        if (!known) {
            fail(node, fmt::format("the type \"{}\" is not read", type));
        }
    }

    /// The same by runs of values: compiled once for each type of them.
    template<class S>
    void read_values(const pugi::xml_node& node, std::uint64_t count, const Start& start,
                     const Take<S>& take) {
        const Stored source = stored(node);
        if (source.is_text) {
            parse_text<S>(node, source.range, count, start, take);
        } else {
            unpack_values<S>(node, source, times(count, sizeof(S)), start, take);
        }
    }

    /// Refuses arrays that share bytes, by which a small file could make a large mesh.
    template<class S>
    void unpack_values(const pugi::xml_node& node, const Stored& source, std::uint64_t most,
                       const Start& start, const Take<S>& take) {
        std::uint64_t done = 0;
        std::vector<S> values;
        const auto begin = [&](std::uint64_t bytes) {
            if (bytes % sizeof(S) != 0) {
                fail(node, fmt::format("{} bytes are no whole number of values", bytes));
            }
            start(bytes / sizeof(S));
        };
        const auto take_bytes = [&](std::string_view bytes) {
            values.resize(bytes.size() / sizeof(S));
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] = load<S>(bytes.data() + i * sizeof(S), format_.swapped);
            }
            take(done, values);
            done += values.size();
        };
        try {
            if (const auto plain = plain_payload(format_, file_, source.range, source.is_base64)) {
                begin(plain->end - plain->begin);
                copy_values<S>(*plain, take);
                consumed_ += plain->end - source.range.begin;
            } else {
                consumed_ +=
                    read_payload(format_, file_, source.range, source.is_base64, most, {begin, take_bytes});
            }
        } catch (const PayloadError& problem) {
            fail(node, problem.what());
        }
        if (consumed_ > file_.size()) {
            fail(node, "its data overlap those of other arrays");
        }
    }

    /// Takes all values in a range: first the first ones, then the others from several threads, which read
    /// directly from the file.
    template<class S>
    void copy_values(FileRange range, const Take<S>& take) const {
        constexpr std::size_t piece = std::size_t{1} << 17;
        const std::size_t count = (range.end - range.begin) / sizeof(S);
        const std::size_t first = std::min(count, piece);
        copy_values<S>(range.begin, 0, first, take);
        parallel_for(count - first, piece, [&](std::size_t begin, std::size_t end) {
            copy_values<S>(range.begin, first + begin, first + end, take);
        });
    }

    /// The same for values [begin, end) of those that begin at a byte.
    template<class S>
    void copy_values(std::size_t byte, std::size_t begin, std::size_t end, const Take<S>& take) const {
        constexpr std::size_t chunk = (std::size_t{1} << 15) / sizeof(S); // small enough to stay in the cache
        std::array<S, chunk> values;
        for (std::size_t done = begin; done < end; done += chunk) {
            const std::size_t count = std::min(chunk, end - done);
            const std::size_t place = byte + done * sizeof(S);
            file_.copy(place, place + count * sizeof(S), reinterpret_cast<char*>(values.data()));
            if (format_.swapped) {
                std::transform(values.begin(), values.begin() + count, values.begin(), [](const S& value) {
                    return load<S>(reinterpret_cast<const char*>(&value), true);
                });
            }
            take(done, std::span{values}.first(count));
        }
    }

    template<class S>
    void parse_text(const pugi::xml_node& node, FileRange range, std::uint64_t count, const Start& start,
                    const Take<S>& take) {
        FileCursor cursor{
            file_, range.begin, range.end,
            fmt::format("{}: array \"{}\"", soup_.path, readable(node.attribute("Name").value()))};
        const bool too_many = count > (range.end - range.begin + 1) / 2;
        const std::uint64_t wanted = too_many ? words_in(range) : count;
        start(wanted);
        for (std::uint64_t i = 0; i < wanted; ++i) {
            if (cursor.at_end()) {
                start(i);
            }
            const S value = text_value<S>(cursor);
            take(i, std::span{&value, 1});
        }
        if (!cursor.at_end()) {
            start(words_in(range));
        }
    }

    template<class S>
    static S text_value(FileCursor& cursor) {
        if constexpr (sizeof(S) > 1) {
            return cursor.parsed<S>("a number");
        } else { // a number, not a character
            const int value = cursor.parsed<int>("a number");
            if (!std::in_range<S>(value)) {
                cursor.fail(fmt::format("{} does not fit its type", value));
            }
            return static_cast<S>(value);
        }
    }

    std::uint64_t words_in(FileRange range) {
        FileCursor cursor{file_, range.begin, range.end, {}};
        std::uint64_t words = 0;
        while (!cursor.word().empty()) {
            ++words;
        }
        return words;
    }

    // --- mesh ---

    /// Adds up the sizes that the pieces claim. Arrays reserve addresses for them, so that they never move,
    /// and take memory only as they are filled. Claims of many times the file's size are not reserved.
    void count_all(const pugi::xml_node& grid) {
        for (const pugi::xml_node piece : grid.children("Piece")) {
            all_points_ += count_attribute(piece, "NumberOfPoints");
            all_cells_ += count_attribute(piece, "NumberOfCells");
        }
    }

    template<class T>
    void reserve(Array<T>& values, std::uint64_t count) const {
        if (times(count, sizeof(T)) / 4 <= file_.size()) {
            values.reserve(count);
        }
    }

    /// Appends `more` values; returns the place of the first.
    template<class T>
    T* grow(Array<T>& values, std::uint64_t more, std::uint64_t all) const {
        reserve(values, all);
        const std::size_t first = values.size();
        values.resize(first + more);
        return values.data() + first;
    }

    /// Appends a piece to those before.
    void read_piece(const pugi::xml_node& piece) {
        const std::uint64_t points = count_attribute(piece, "NumberOfPoints");
        const std::uint64_t cells = count_attribute(piece, "NumberOfCells");
        if (points == 0 && cells == 0) { // parallel writers make such pieces, even without arrays
            return;
        }
        first_point_ = soup_.points.size();
        read_points(piece, points);
        read_cells(piece, cells);
        read_data(soup_.point_data, piece, "PointData", points, all_points_);
        read_data(soup_.cell_data, piece, "CellData", cells, all_cells_);
        is_first_piece_ = false;
    }

    void read_points(const pugi::xml_node& piece, std::uint64_t count) {
        const pugi::xml_node node = piece.child("Points").child("DataArray");
        const auto start = [&](std::uint64_t values) {
            if (values % 3 != 0 || values / 3 != count) {
                fail(node, fmt::format("{} values are no {} points of 3 coordinates", values, count));
            }
            checked_index(first_point_ + count, "points");
            Point<3>* const first = grow(soup_.points, count, all_points_);
            return count > 0 ? first->data() : nullptr;
        };
        values(node, type_of(node), times(3, count), start, [&](double* x, std::uint64_t i, auto value) {
            x[i] = static_cast<double>(value);
            if (!std::isfinite(x[i])) {
                fail(node, fmt::format("point {} has a coordinate that is not a finite number", i / 3));
            }
        });
    }

    static std::string_view type_of(const pugi::xml_node& node) { return node.attribute("type").value(); }

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
        if (has_equal_cells(array("types"), count)) {
            const std::size_t corners = dimension_ + 1;
            check_offsets(array("offsets"), count, corners);
            read_connectivity(array("connectivity"), times(count, corners), corners);
        } else {
            separate_cells_before();
            read_mixed_cells(array("offsets"), array("connectivity"));
        }
        cells_before_ += count;
    }

    /// Whether all cells, including those of earlier pieces, are straight simplices of one kind; else their
    /// types are in types_.
    bool has_equal_cells(const pugi::xml_node& node, std::uint64_t claimed) {
        const auto start = [&](std::uint64_t types) {
            if (types != claimed) {
                fail(node, fmt::format("{} cells are claimed, {} types are there", claimed, types));
            }
            checked_index(types, "cells");
            types_.clear();
            return grow(types_, types, claimed);
        };
        values(node, type_of(node), claimed, start, [&](std::uint8_t* types, std::uint64_t cell, auto value) {
            const auto type = static_cast<std::int64_t>(value);
            types[cell] = require_type(node, cell, type);
        });
        const bool equal =
            std::equal(types_.begin() + (types_.empty() ? 0 : 1), types_.end(), types_.begin());
        const int type = types_.empty() ? 0 : types_.front();
        const auto dimension = static_cast<std::size_t>(std::max(0, vtk_simplex_dimension(type)));
        if (is_mixed_ || !equal || vtk_is_curved(type) || dimension == 0 ||
            (dimension_ != 0 && dimension_ != dimension)) {
            return types_.empty();
        }
        dimension_ = dimension;
        types_ = {};
        return true;
    }

    std::uint8_t require_type(const pugi::xml_node& node, std::uint64_t cell, std::int64_t type) const {
        const int number = static_cast<int>(type & 0xFF);
        if (type != number || vtk_simplex_dimension(number) < 0) {
            fail(node,
                 fmt::format("cell {} is a {}; only vertices, lines, triangles and tetrahedra are read; mesh "
                             "with simplices, or split these cells",
                             cell, vtk_type_name(number)));
        }
        if (vtk_is_curved(number) && !options_.linear) {
            fail(node, fmt::format("cell {} is a {}; {}", cell, vtk_type_name(number), how_to_take_corners));
        }
        return static_cast<std::uint8_t>(number);
    }

    /// Called when cells turn out to be of several kinds: gives tags to those of earlier pieces.
    void separate_cells_before() {
        if (!is_mixed_ && dimension_ != 0) {
            auto& tags = soup_.simplices[dimension_].tags;
            tags.resize(soup_.simplices[dimension_].size(static_cast<int>(dimension_)));
            std::iota(tags.begin(), tags.end(), std::int64_t{0});
        }
        is_mixed_ = true;
    }

    void read_mixed_cells(const pugi::xml_node& offset_node, const pugi::xml_node& node) {
        Array<std::int64_t> ends;
        const auto start = [&](std::uint64_t offsets) {
            if (offsets != types_.size()) {
                fail(offset_node, fmt::format("{} offsets for {} cells", offsets, types_.size()));
            }
            return grow(ends, offsets, offsets);
        };
        values(offset_node, type_of(offset_node), types_.size(), start,
               [](std::int64_t* place, std::uint64_t i, auto value) {
                   place[i] = static_cast<std::int64_t>(value);
               });
        const Array<Index> vertices = vertices_of_cells(node, ends.empty() ? 0 : ends.back());
        std::int64_t begin = 0;
        for (std::size_t cell = 0; cell < ends.size(); begin = ends[cell++]) {
            const auto corners = vtk_simplex_dimension(types_[cell]) + 1;
            const bool fits =
                vtk_is_curved(types_[cell]) ? ends[cell] - begin > corners : ends[cell] - begin == corners;
            if (!fits || ends[cell] > static_cast<std::int64_t>(vertices.size())) {
                fail(offset_node, fmt::format("cell {} is a {}, but it has not {} vertices", cell,
                                              vtk_type_name(types_[cell]), corners));
            }
            add_cell(cell, std::span{vertices}.subspan(static_cast<std::size_t>(begin),
                                                       static_cast<std::size_t>(ends[cell] - begin)));
        }
    }

    Array<Index> vertices_of_cells(const pugi::xml_node& node, std::int64_t claimed) {
        const std::uint64_t points = soup_.points.size() - first_point_;
        Array<Index> vertices;
        const auto start = [&](std::uint64_t count) {
            if (std::cmp_not_equal(count, claimed)) {
                fail(node, fmt::format("{} vertices, but the cells end at {}", count, claimed));
            }
            return grow(vertices, count, count);
        };
        const auto most = static_cast<std::uint64_t>(std::max<std::int64_t>(0, claimed));
        values(node, type_of(node), most, start, [&](Index* place, std::uint64_t i, auto value) {
            if (value < 0 || static_cast<std::uint64_t>(value) >= points) {
                fail(node,
                     fmt::format("place {} names a point that does not exist; there are {}", i, points));
            }
            place[i] = static_cast<Index>(first_point_ + static_cast<std::uint64_t>(value));
        });
        return vertices;
    }

    void add_cell(std::size_t cell, std::span<const Index> vertices) {
        const auto dimension = static_cast<std::size_t>(vtk_simplex_dimension(types_[cell]));
        SimplexBlock& block = soup_.simplices[dimension];
        block.vertices.insert(block.vertices.end(), vertices.begin(),
                              vertices.begin() + static_cast<std::ptrdiff_t>(dimension + 1));
        block.tags.push_back(static_cast<std::int64_t>(cells_before_ + cell));
        for (const Index vertex : vertices.subspan(dimension + 1)) {
            corners_only_.add_between(vertex, soup_.points.size());
        }
        corners_only_.add_cells(vtk_is_curved(types_[cell]) ? 1 : 0);
    }

    void check_offsets(const pugi::xml_node& node, std::uint64_t cells, std::size_t corners) {
        const auto start = [&](std::uint64_t offsets) {
            if (offsets != cells) {
                fail(node, fmt::format("{} offsets for {} cells", offsets, cells));
            }
            return nullptr;
        };
        values(node, type_of(node), cells, start, [&](std::nullptr_t, std::uint64_t cell, auto value) {
            if (static_cast<std::int64_t>(value) != static_cast<std::int64_t>((cell + 1) * corners)) {
                fail(node, fmt::format("cell {} has not {} vertices", cell, corners));
            }
        });
    }

    void read_connectivity(const pugi::xml_node& node, std::uint64_t count, std::size_t corners) {
        const std::uint64_t points = soup_.points.size() - first_point_;
        const auto start = [&](std::uint64_t vertices) {
            if (vertices != count) {
                fail(node, fmt::format("{} vertices for {} cells of {}", vertices, count / corners, corners));
            }
            return grow(soup_.simplices[dimension_].vertices, count, times(all_cells_, corners));
        };
        values(node, type_of(node), count, start, [&](Index* vertices, std::uint64_t i, auto value) {
            if (value < 0 || static_cast<std::uint64_t>(value) >= points) {
                fail(node, fmt::format("cell {} names a point that does not exist; there are {}", i / corners,
                                       points));
            }
            vertices[i] = static_cast<Index>(first_point_ + static_cast<std::uint64_t>(value));
        });
    }

    // --- data ---

    /// Reads the data of a piece; every piece must have the same arrays in the same order.
    void read_data(std::vector<DataArray>& arrays, const pugi::xml_node& piece, const char* section,
                   std::uint64_t rows, std::uint64_t all_rows) {
        std::size_t place = 0;
        for (const pugi::xml_node node : piece.child(section).children("DataArray")) {
            DataArray array = empty_array(node);
            if (is_first_piece_) {
                arrays.push_back(std::move(array));
            } else if (place >= arrays.size() || arrays[place].name != array.name ||
                       arrays[place].components != array.components ||
                       arrays[place].values.index() != array.values.index()) {
                fail(node, "the arrays of the pieces differ in name, type, components or order");
            }
            append_values(node, arrays[place++], rows, all_rows);
        }
        if (place != arrays.size()) {
            fail(piece, fmt::format("its array \"{}\" in {} is missing", arrays[place].name, section));
        }
    }

    /// An array's name, type and components, without values.
    DataArray empty_array(const pugi::xml_node& node) const {
        DataArray array;
        array.name = as_utf8(node.attribute("Name").value());
        array.components = node.attribute("NumberOfComponents").as_int(1);
        if (array.components < 1) {
            fail(node, fmt::format("{} is no number of components", array.components));
        }
        if (is_text(node)) {
            array.values = std::vector<std::string>{};
        } else if (type_of(node).starts_with("Float")) {
            array.values = Array<double>{};
        } else {
            array.values = IntegerList{};
        }
        return array;
    }

    static bool is_text(const pugi::xml_node& node) {
        return type_of(node) == "String" || node.attribute(text_mark);
    }

    DataArray field_array(const pugi::xml_node& node) {
        DataArray array = empty_array(node);
        const std::uint64_t tuples =
            node.attribute("NumberOfTuples") ? count_attribute(node, "NumberOfTuples") : any_count;
        append_values(node, array, std::nullopt, tuples);
        return array;
    }

    /// Appends an array's values: `rows` rows if given, else any number up to `all_rows`.
    void append_values(const pugi::xml_node& node, DataArray& array, std::optional<std::uint64_t> rows,
                       std::uint64_t all_rows) {
        const auto width = static_cast<std::uint64_t>(array.components);
        const auto require_rows = [&](std::uint64_t size) {
            if (size % width != 0 || (rows && size / width != *rows)) {
                fail(node, fmt::format("{} values are no {} rows of {}", size, rows.value_or(0), width));
            }
        };
        const std::uint64_t most = times(rows.value_or(all_rows), width);
        if (auto* strings = std::get_if<std::vector<std::string>>(&array.values)) {
            std::vector<std::string> more = texts(node, rows ? any_count : all_rows);
            require_rows(more.size());
            std::move(more.begin(), more.end(), std::back_inserter(*strings));
        } else if (auto* reals = std::get_if<Array<double>>(&array.values)) {
            const auto start = [&](std::uint64_t more) {
                require_rows(more);
                return grow(*reals, more, rows ? times(all_rows, width) : more);
            };
            values(node, type_of(node), most, start,
                   [](double* place, std::uint64_t i, auto value) { place[i] = static_cast<double>(value); });
        } else {
            auto& all = std::get<IntegerList>(array.values);
            IntegerList more = integers(node, most, require_rows);
            if (all.empty()) {
                all = std::move(more);
            } else {
                all.append_list(more);
            }
        }
    }

    /// Integers in 32 bits if all fit, as they mostly do; else the array is read again in 64 bits.
    template<class RequireRows>
    IntegerList integers(const pugi::xml_node& node, std::uint64_t most, const RequireRows& require_rows) {
        std::atomic<bool> all_fit = true;
        const std::uint64_t consumed = consumed_;
        Array<std::int32_t> narrow = integers<std::int32_t>(
            node, most, require_rows, [&](auto) { all_fit.store(false, std::memory_order_relaxed); });
        if (all_fit) {
            return narrow;
        }
        narrow = {};
        consumed_ = consumed;
        return integers<std::int64_t>(node, most, require_rows,
                                      [&](auto value) { fail(node, fmt::format("{} is too large", value)); });
    }

    /// Integers as T. Calls too_large(value), from several threads, for those that do not fit.
    template<class T, class RequireRows, class TooLarge>
    Array<T> integers(const pugi::xml_node& node, std::uint64_t most, const RequireRows& require_rows,
                      const TooLarge& too_large) {
        Array<T> all;
        const auto start = [&](std::uint64_t count) {
            require_rows(count);
            return grow(all, count, count);
        };
        values(node, type_of(node), most, start, [&](T* place, std::uint64_t i, auto value) {
            if constexpr (std::integral<decltype(value)>) { // always so here
                if (std::in_range<T>(value)) {
                    place[i] = static_cast<T>(value);
                } else {
                    too_large(value);
                }
            }
        });
        return all;
    }

    std::vector<std::string> texts(const pugi::xml_node& node, std::uint64_t most) {
        std::string characters;
        const auto start = [&](std::uint64_t bytes) {
            characters.resize(bytes);
            return characters.data();
        };
        const bool of_vtk = type_of(node) == "String";
        values(node, vtk_name<std::uint8_t>(), of_vtk ? any_count : most, start,
               [](char* place, std::uint64_t i, auto code) { place[i] = static_cast<char>(code); });
        std::vector<std::string> result;
        for (std::size_t begin = 0; begin < characters.size();) {
            const std::size_t end = std::min(characters.find('\0', begin), characters.size());
            result.push_back(characters.substr(begin, end - begin));
            begin = end + 1;
        }
        return result;
    }

    FileBytes& file_;
    VtuSkeleton skeleton_;
    const ReadOptions& options_;
    CornersOnly corners_only_;
    pugi::xml_document document_;
    PayloadFormat format_;
    std::uint64_t consumed_ = 0; ///< bytes of the file that arrays were read from
    std::size_t dimension_ = 0;  ///< of equal cells; 0 until there is one
    bool is_mixed_ = false;      ///< cells are of several kinds or curved: tags are their rows
    Array<std::uint8_t> types_;  ///< types of the piece's cells, if mixed
    std::uint64_t cells_before_ = 0;
    std::size_t first_point_ = 0;  ///< first point of the piece
    std::uint64_t all_points_ = 0; ///< points that the pieces claim
    std::uint64_t all_cells_ = 0;
    bool is_first_piece_ = true;
    Soup soup_;
};

} // namespace

Soup read_vtu(const std::filesystem::path& path) {
    return read_vtu(path, ReadOptions{});
}

Soup read_vtu(const std::filesystem::path& path, const ReadOptions& options) {
    FileBytes file{path};
    return VtuReader{file, options}.read(false);
}

Soup read_vtu_piece(const std::filesystem::path& path, const ReadOptions& options) {
    FileBytes file{path};
    Soup soup = VtuReader{file, options}.read(true);
    const auto kinds = std::count_if(soup.simplices.begin(), soup.simplices.end(),
                                     [](const SimplexBlock& block) { return !block.vertices.empty(); });
    if (kinds == 1) {
        soup.simplices[static_cast<std::size_t>(soup.top_dimension())].tags = {};
        soup.point_tags = {};
    }
    return soup;
}

std::vector<std::string> pvtu_sources(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    pugi::xml_document document;
    const pugi::xml_parse_result result =
        document.load_buffer(bytes.data(), bytes.size(), pugi::parse_default, pugi::encoding_utf8);
    const pugi::xml_node grid = document.child("VTKFile").child("PUnstructuredGrid");
    if (!result || !grid) {
        throw InputError(fmt::format("{}: byte {}: this is no PVTU file{}{}", path.string(), result.offset,
                                     result ? "" : ": ", result ? "" : result.description()));
    }
    std::vector<std::string> sources;
    for (const pugi::xml_node piece : grid.children("Piece")) {
        sources.emplace_back(piece.attribute("Source").value());
    }
    return sources;
}

} // namespace slabhull::io
