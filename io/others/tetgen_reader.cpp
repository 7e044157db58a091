// SPDX-License-Identifier: BSD-3-Clause
// The formats are described in TetGen's manual, section "File Formats".
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/files/percent_text.h"
#include "io/mesh/cell_groups.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/readers.h"
#include "io/others/tetgen_names.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace slabhull::io {

namespace {

/// A file of rows of numbers. Comments are blanked out, except ours with the attributes.
struct TetgenFile {
    Array<char> bytes;
    FileCursor in;
    std::string attributes; ///< content of our comment

    explicit TetgenFile(const std::filesystem::path& path)
        : bytes{read_bytes(path)}, in{{bytes.data(), bytes.size()}, path.string()} {
        for (auto it = bytes.begin(); (it = std::find(it, bytes.end(), '#')) != bytes.end();) {
            const auto end = std::find(it, bytes.end(), '\n');
            const std::string_view comment{&*it, static_cast<std::size_t>(end - it)};
            if (attributes.empty() && comment.starts_with(attribute_mark)) {
                attributes = comment.substr(std::string_view{attribute_mark}.size());
            }
            std::fill(it, end, ' ');
        }
    }

    /// The counts in the next line that is not empty; missing ones keep the given values.
    template<std::size_t n>
    std::array<std::uint64_t, n> counts(std::array<std::uint64_t, n> given) {
        in.skip_blanks();
        const std::size_t start = in.offset();
        std::string_view line = in.line();
        for (std::size_t i = 0; i < n; ++i) {
            line.remove_prefix(std::min(line.find_first_not_of(" \t,"), line.size()));
            if (line.empty() && i > 0) {
                break;
            }
            const auto [stop, problem] = std::from_chars(line.data(), line.data() + line.size(), given[i]);
            if (problem != std::errc{} || (stop != line.data() + line.size() && !is_blank(*stop))) {
                in.fail_at(start, "counts were expected");
            }
            line.remove_prefix(static_cast<std::size_t>(stop - line.data()));
        }
        return given;
    }

    /// A checked count of rows of so many words each.
    std::size_t rows(std::uint64_t count, std::size_t words, const char* what) const {
        return in.plausible(count, 2 * words - 1, what);
    }

    /// Reads and checks the number that starts a row; numbers start from `first`.
    void number(std::size_t row, std::int64_t first, const char* what) {
        const auto given = in.parsed<std::int64_t>(what);
        const std::int64_t wanted = static_cast<std::int64_t>(row) + first;
        if (given != wanted) {
            in.fail(fmt::format("{} {} was expected, not {}", what, wanted, given));
        }
    }

    std::size_t words_in_row() {
        in.skip_blanks();
        const std::string_view rest = in.rest();
        std::size_t words = 0;
        bool within = false;
        for (std::size_t k = 0; k < rest.size() && rest[k] != '\n'; ++k) {
            const bool blank = is_blank(rest[k]) || rest[k] == ',';
            words += !blank && !within ? 1 : 0;
            within = !blank;
        }
        return words;
    }

    bool row_ends() const {
        const std::string_view rest = in.rest();
        const std::size_t next = rest.find_first_not_of(" \t\r");
        return next == std::string_view::npos || rest[next] == '\n';
    }

    void end_row(const char* what, std::size_t row) {
        const std::size_t start = in.offset();
        const std::string_view rest = in.line();
        if (!std::all_of(rest.begin(), rest.end(), is_blank)) {
            in.fail_at(start,
                       fmt::format("the row of {} {} has more values than its header tells", what, row));
        }
    }
};

/// Attributes as arrays: those of our comment, if it lists as many columns as there are, else one per column.
class Attributes {
public:
    Attributes(const std::string& told, std::size_t count, std::size_t rows) {
        if (!parse(told) || width() != count) {
            arrays_.clear();
            for (std::size_t k = 0; k < count; ++k) {
                arrays_.push_back({fmt::format("attribute_{}", k), 1, Array<double>{}});
            }
        }
        for (DataArray& array : arrays_) {
            if (auto* reals = std::get_if<Array<double>>(&array.values)) {
                reals->reserve(rows * static_cast<std::size_t>(array.components));
            }
        }
    }

    void read_row(FileCursor& in) {
        for (DataArray& array : arrays_) {
            for (int k = 0; k < array.components; ++k) {
                if (auto* reals = std::get_if<Array<double>>(&array.values)) {
                    reals->push_back(in.parsed<double>("an attribute"));
                } else {
                    std::get<IntegerList>(array.values)
                        .push_back(in.parsed<std::int64_t>("an integer attribute"));
                }
            }
        }
    }

    std::vector<DataArray> take() { return std::move(arrays_); }

private:
    std::size_t width() const {
        std::size_t sum = 0;
        for (const DataArray& array : arrays_) {
            sum += static_cast<std::size_t>(array.components);
        }
        return sum;
    }

    bool parse(const std::string& told) {
        FileCursor words{told, {}};
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
            const std::size_t second = word.rfind(':');
            const std::size_t first = second == 0 ? second : word.rfind(':', second - 1);
            if (second == std::string_view::npos || first == std::string_view::npos || first == second) {
                return false;
            }
            const std::string_view type = word.substr(first + 1, second - first - 1);
            constexpr int most = 1000;
            int components = 0;
            std::from_chars(word.data() + second + 1, word.data() + word.size(), components);
            if ((type != "real" && type != "integer") || components < 1 || components > most) {
                return false;
            }
            DataArray array{percent_decoded(word.substr(0, first)), components, Array<double>{}};
            if (type == "integer") {
                array.values = IntegerList{};
            }
            arrays_.push_back(std::move(array));
        }
        return true;
    }

    std::vector<DataArray> arrays_;
};

class TetgenReader {
public:
    TetgenReader(const std::filesystem::path& path, const ReadOptions& options)
        : path_{path}, options_{options} {
        soup_.path = path.string();
    }

    Soup read() {
        const std::string extension = lower_extension(path_);
        if (extension == ".poly" || extension == ".smesh") {
            read_complex(extension == ".poly");
        } else if (extension == ".face") {
            read_beside(".node", &TetgenReader::read_nodes);
            read_faces_of(path_);
        } else if (extension == ".node" || extension == ".ele") {
            read_all(extension == ".ele");
        } else {
            throw InputError(fmt::format(
                "{}: a TetGen file called .node, .ele, .face, .poly or .smesh was expected", path_.string()));
        }
        list_groups_in_use(soup_);
        corners_only_.finish(soup_);
        return std::move(soup_);
    }

private:
    // --- files ---

    std::filesystem::path beside(const char* extension) const {
        return lower_extension(path_) == extension
                   ? path_
                   : std::filesystem::path{path_}.replace_extension(extension);
    }

    void read_beside(const char* extension, void (TetgenReader::*read_rows)(TetgenFile&)) {
        TetgenFile file{beside(extension)};
        (this->*read_rows)(file);
        require_end(file);
    }

    void read_all(bool cells_wanted) {
        const auto exists = [&](const char* extension) { return std::filesystem::exists(beside(extension)); };
        read_beside(".node", &TetgenReader::read_nodes);
        if (cells_wanted || exists(".ele")) {
            read_beside(".ele", &TetgenReader::read_cells);
            if (exists(".neigh")) {
                read_beside(".neigh", &TetgenReader::read_neighbors);
            }
        }
        if (exists(".face") && soup_.simplices[2].vertices.empty()) {
            read_faces_of(beside(".face"));
        }
    }

    void read_faces_of(const std::filesystem::path& path) {
        TetgenFile file{path};
        read_faces(file);
        require_end(file);
    }

    static void require_end(TetgenFile& file) {
        if (!file.in.at_end()) {
            file.in.fail("there are more rows than the header tells");
        }
    }

    // --- points ---

    void read_nodes(TetgenFile& file) {
        const auto [claimed, dimension, attribute_count, markers] = file.counts<4>({0, 3, 0, 0});
        if (dimension < 2 || dimension > 3 || markers > 1 || attribute_count > most_attributes) {
            file.in.fail(fmt::format("{} dimensions, {} attributes, {} markers are not what a point has",
                                     dimension, attribute_count, markers));
        }
        const std::size_t rows = file.rows(claimed, 1 + dimension + attribute_count + markers, "points");
        checked_index(rows, "points");
        soup_.points.reserve(rows);
        Attributes attributes{file.attributes, attribute_count, rows};
        Array<std::int64_t> marker;
        for (std::size_t row = 0; row < rows; ++row) {
            begin_point(file, row);
            soup_.points.push_back(point(file, dimension, "point", row + first()));
            attributes.read_row(file.in);
            if (markers == 1) {
                marker.push_back(file.in.parsed<std::int64_t>("a marker"));
            }
            file.end_row("point", row + first());
        }
        soup_.point_data = attributes.take();
        if (markers == 1) {
            soup_.point_data.push_back({"marker", 1, std::move(marker)});
        }
    }

    /// The first point's number is where all numbers start.
    void begin_point(TetgenFile& file, std::size_t row) {
        if (row > 0) {
            file.number(row, first_, "point");
        } else if (first_ = file.in.parsed<std::int64_t>("the first point's number");
                   first_ != 0 && first_ != 1) {
            file.in.fail(fmt::format("the first point is numbered {}, not 0 or 1", first_));
        }
        if (first_ == 1) {
            soup_.point_tags.push_back(static_cast<std::int64_t>(row) + 1);
        }
    }

    static Point<3> point(TetgenFile& file, std::uint64_t dimension, const char* what, std::size_t number) {
        Point<3> x{};
        for (std::size_t i = 0; i < dimension; ++i) {
            x[i] = file.in.parsed<double>("a coordinate");
            if (!std::isfinite(x[i])) {
                file.in.fail(fmt::format("{} {} has a coordinate that is not a finite number", what, number));
            }
        }
        return x;
    }

    std::size_t first() const { return static_cast<std::size_t>(first_); }

    // --- simplices ---

    void read_cells(TetgenFile& file) {
        const auto [claimed, nodes, attribute_count] = file.counts<3>({0, 4, 0});
        const bool curved = nodes == 6 || nodes == 10;
        const std::size_t corners = nodes == 10 ? 4 : nodes == 6 ? 3 : nodes;
        if ((corners != 3 && corners != 4) || attribute_count > most_attributes) {
            file.in.fail(
                fmt::format("{} corners and {} attributes: only tetrahedra of 4 corners and triangles of 3 "
                            "are read",
                            nodes, attribute_count));
        }
        if (curved) {
            require_linear(file, fmt::format("cells of {} nodes are of second order", nodes));
        }
        const std::size_t rows = file.rows(claimed, 1 + nodes + attribute_count, "cells");
        checked_index(rows, "cells");
        SimplexBlock& block = soup_.simplices[corners - 1];
        block.vertices.reserve(rows * corners);
        corners_only_.add_cells(curved ? rows : 0);
        Attributes attributes{file.attributes, attribute_count, rows};
        for (std::size_t row = 0; row < rows; ++row) {
            read_simplex(file, block, corners, row, "cell");
            pass_between(file, nodes - corners, row, "cell");
            attributes.read_row(file.in);
            file.end_row("cell", row + first());
        }
        soup_.cell_data = attributes.take();
        take_groups(block);
    }

    /// Takes the groups of cells from the attribute where write_tetgen() puts them.
    void take_groups(SimplexBlock& block) {
        const auto found =
            std::find_if(soup_.cell_data.begin(), soup_.cell_data.end(), [](const DataArray& array) {
                return array.name == group_attribute && array.components == 1 &&
                       std::holds_alternative<IntegerList>(array.values);
            });
        if (found == soup_.cell_data.end()) {
            return;
        }
        for (const std::int64_t number : std::get<IntegerList>(found->values)) {
            block.physical.push_back(group_of(number));
        }
        soup_.cell_data.erase(found);
    }

    /// Only positive numbers are groups.
    static PatchNumber group_of(std::int64_t number) {
        return number > 0 && std::in_range<PatchNumber>(number) ? static_cast<PatchNumber>(number) : 0;
    }

    void read_simplex(TetgenFile& file, SimplexBlock& block, std::size_t corners, std::size_t row,
                      const char* what) {
        file.number(row, first_, what);
        for (std::size_t k = 0; k < corners; ++k) {
            block.vertices.push_back(vertex(file, row, what));
        }
        add_tag(block, row);
    }

    /// Skips the nodes of a curved simplex that follow its corners.
    void pass_between(TetgenFile& file, std::size_t count, std::size_t row, const char* what) {
        for (std::size_t k = 0; k < count; ++k) {
            corners_only_.add_between(vertex(file, row, what), soup_.points.size());
        }
    }

    void require_linear(TetgenFile& file, const std::string& found) const {
        if (!options_.linear) {
            file.in.fail(fmt::format("{}; {}", found, how_to_take_corners));
        }
    }

    void add_tag(SimplexBlock& block, std::size_t row) const {
        if (first_ == 1) {
            block.tags.push_back(static_cast<std::int64_t>(row) + 1);
        }
    }

    Index vertex(TetgenFile& file, std::size_t row, const char* what) const {
        const auto given = file.in.parsed<std::int64_t>("a point's number");
        if (given < first_ || std::cmp_greater_equal(given - first_, soup_.points.size())) {
            file.in.fail(fmt::format("{} {} names point {}, which does not exist; there are {}", what,
                                     row + first(), given, soup_.points.size()));
        }
        return static_cast<Index>(given - first_);
    }

    /// With -nn TetGen adds the cells on both sides, with -o2 three nodes between the corners. The header
    /// shows neither, but the number of words in a row does. The cells are skipped.
    void read_faces(TetgenFile& file) {
        const auto [claimed, markers] = file.counts<2>({0, 0});
        const std::size_t marks = markers > 0 ? 1 : 0;
        const std::size_t rows = file.rows(claimed, 4, "triangles");
        checked_index(rows, "triangles");
        SimplexBlock& block = soup_.simplices[2];
        for (std::size_t row = 0; row < rows; ++row) {
            const std::size_t words = file.words_in_row();
            const bool curved = words == 7 + marks || words == 9 + marks;
            if (!curved && words != 4 + marks && words != 6 + marks) {
                file.in.fail(fmt::format("the row of triangle {} has {} values", row + first(), words));
            }
            read_simplex(file, block, 3, row, "triangle");
            if (curved) {
                require_linear(file,
                               fmt::format("triangle {} has 6 nodes, it is of second order", row + first()));
                pass_between(file, 3, row, "triangle");
                corners_only_.add_cells(1);
            }
            if (markers > 0) {
                add_marker(file.in.parsed<std::int64_t>("a marker"));
            }
            file.in.line();
        }
        keep_markers();
    }

    void add_marker(std::int64_t marker) {
        markers_.push_back(marker);
        soup_.simplices[2].physical.push_back(group_of(marker));
    }

    /// Data can only be on simplices of the largest dimension.
    void keep_markers() {
        if (!markers_.empty() && soup_.simplices[3].vertices.empty()) {
            soup_.cell_data.push_back({"marker", 1, std::move(markers_)});
        }
    }

    // --- adjacency ---

    void read_neighbors(TetgenFile& file) {
        const auto top = static_cast<std::size_t>(soup_.top_dimension());
        const auto [claimed, width] = file.counts<2>({0, top + 1});
        const std::size_t cells = soup_.simplices[top].size(static_cast<int>(top));
        if (claimed != cells || width != top + 1) {
            file.in.fail(fmt::format("{} rows of {} neighbors for {} cells of {} corners", claimed, width,
                                     cells, top + 1));
        }
        Array<std::int64_t> neighbors;
        neighbors.reserve(cells * width);
        for (std::size_t cell = 0; cell < cells; ++cell) {
            file.number(cell, first_, "cell");
            for (std::size_t i = 0; i < width; ++i) {
                neighbors.push_back(neighbor(file, soup_.simplices[top].vertices, width, cell, i));
            }
            file.end_row("cell", cell + first());
        }
        soup_.cell_data.push_back({"neighbors", static_cast<int>(width), std::move(neighbors)});
    }

    /// The neighbour across the facet opposite to corner i; -1 for none.
    std::int64_t neighbor(TetgenFile& file, const Array<Index>& vertices, std::size_t width, std::size_t cell,
                          std::size_t i) const {
        const auto given = file.in.parsed<std::int64_t>("a neighbor");
        if (given == -1) {
            return -1;
        }
        const bool exists = given >= first_ && std::cmp_less(given - first_, vertices.size() / width);
        const Index* one = &vertices[cell * width];
        const Index* other = exists ? &vertices[static_cast<std::size_t>(given - first_) * width] : one;
        for (std::size_t k = 0; k < width; ++k) {
            if (!exists || (k != i && std::find(other, other + width, one[k]) == other + width)) {
                file.in.fail(fmt::format("cell {} is no neighbor of cell {} opposite to its corner {}", given,
                                         cell + first(), i));
            }
        }
        return given - first_;
    }

    // --- piecewise linear complexes ---

    void read_complex(bool nested) {
        TetgenFile file{path_};
        read_nodes(file);
        if (soup_.points.empty()) {
            read_beside(".node", &TetgenReader::read_nodes);
        }
        const auto [claimed, markers] = file.counts<2>({0, 0});
        const std::size_t facets = file.rows(claimed, nested ? 5 : 4, "facets");
        for (std::size_t facet = 0; facet < facets; ++facet) {
            nested ? read_nested_facet(file, facet, markers > 0) : read_facet(file, facet, markers > 0);
        }
        checked_index(soup_.simplices[2].size(2), "triangles");
        keep_markers();
        read_places(file, "holes", 3, 3);
        read_places(file, "regions", 4, 5);
        require_end(file);
    }

    void read_facet(TetgenFile& file, std::size_t facet, bool marked) {
        read_polygon(file, facet);
        if (marked) {
            add_marker(file.in.parsed<std::int64_t>("a marker"));
        }
        file.end_row("facet", facet + first());
    }

    void read_nested_facet(TetgenFile& file, std::size_t facet, bool marked) {
        file.in.skip_blanks();
        FileCursor head{file.in.rest().substr(0, std::min(file.in.rest().find('\n'), file.in.rest().size())),
                        {}};
        const auto [claimed, holes] = file.counts<2>({1, 0});
        if (holes > 0) {
            file.in.fail(fmt::format("facet {} has holes; only triangles are read", facet + first()));
        }
        const std::int64_t marker = marked ? third(head) : 0;
        const std::size_t polygons = file.rows(claimed, 4, "polygons");
        for (std::size_t i = 0; i < polygons; ++i) {
            read_polygon(file, facet);
            if (marked) {
                add_marker(marker);
            }
            file.end_row("facet", facet + first());
        }
    }

    /// The third number of a line; 0 if there are fewer.
    static std::int64_t third(FileCursor& line) {
        std::string_view word;
        for (int i = 0; i < 3; ++i) {
            word = line.word();
        }
        std::int64_t value = 0;
        std::from_chars(word.data(), word.data() + word.size(), value);
        return value;
    }

    void read_polygon(TetgenFile& file, std::size_t facet) {
        const auto corners = file.in.parsed<std::int64_t>("a count of corners");
        if (corners != 3) {
            file.in.fail(fmt::format("facet {} has a polygon of {} corners; only triangles are read",
                                     facet + first(), corners));
        }
        SimplexBlock& block = soup_.simplices[2];
        add_tag(block, block.size(2));
        for (int k = 0; k < 3; ++k) {
            block.vertices.push_back(vertex(file, facet, "facet"));
        }
    }

    /// Reads rows of a number, a place and, for regions, an attribute and an optional largest volume.
    void read_places(TetgenFile& file, const char* name, std::size_t least, std::size_t width) {
        if (file.in.at_end()) {
            return;
        }
        const std::size_t rows = file.rows(file.counts<1>({0})[0], 1 + least, name);
        Array<double> values;
        for (std::size_t row = 0; row < rows; ++row) {
            file.in.parsed<std::int64_t>("a number");
            const Point<3> x = point(file, 3, name, row);
            values.insert(values.end(), x.begin(), x.end());
            for (std::size_t k = 3; k < width; ++k) {
                values.push_back(file.row_ends() ? -1 : file.in.parsed<double>(name)); // -1: no bound
            }
            file.end_row(name, row);
        }
        if (rows > 0) {
            soup_.field_data.push_back({name, static_cast<int>(width), std::move(values)});
        }
    }

    static constexpr std::uint64_t most_attributes = 1000;

    std::filesystem::path path_;
    const ReadOptions& options_;
    CornersOnly corners_only_;
    Soup soup_;
    std::int64_t first_ = 0; ///< where numbers start
    Array<std::int64_t> markers_;
};

} // namespace

Soup read_tetgen(const std::filesystem::path& path) {
    return read_tetgen(path, ReadOptions{});
}

Soup read_tetgen(const std::filesystem::path& path, const ReadOptions& options) {
    return TetgenReader{path, options}.read();
}

} // namespace slabhull::io
