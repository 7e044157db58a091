// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/mesh/mesh_pieces.h"
#include "io/mesh/mixed_cells.h"
#include "io/mesh/readers.h"
#include "io/vtk/vtu_pieces.h"
#include "slabhull/core/error.h"
#include "slabhull/core/index.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace slabhull::io {

namespace {

// --- files, one behind the other ---

class Pieces {
public:
    explicit Pieces(std::string path) : path_{std::move(path)} {}

    void add(Soup piece) {
        if (piece.points.empty() && piece.top_dimension() == 0) {
            return;
        }
        if (all_.points.empty()) {
            all_ = std::move(piece);
            return;
        }
        if (piece.top_dimension() != all_.top_dimension()) {
            fail(piece, "its cells are not of the kind of those in the pieces before");
        }
        add_cells(piece);
        all_.points.insert(all_.points.end(), piece.points.begin(), piece.points.end());
        add_data(all_.point_data, piece, piece.point_data);
        add_data(all_.cell_data, piece, piece.cell_data);
        all_.remarks.insert(all_.remarks.end(), piece.remarks.begin(), piece.remarks.end());
    }

    Soup joined() && {
        all_.path = path_;
        return std::move(all_);
    }

private:
    [[noreturn]] void fail(const Soup& piece, const std::string& text) const {
        throw InputError(fmt::format("{}: piece {}: {}", path_, piece.path, text));
    }

    void add_cells(const Soup& piece) {
        const auto top = static_cast<std::size_t>(piece.top_dimension());
        if (!piece.simplices[top].tags.empty()) {
            fail(piece, "its cells are of several kinds, which are read from a .vtu by itself only");
        }
        const auto first = static_cast<Index>(all_.points.size());
        checked_index(first + piece.points.size(), "points");
        Array<Index>& all = all_.simplices[top].vertices;
        const Array<Index>& more = piece.simplices[top].vertices;
        checked_index((all.size() + more.size()) / (top + 1), "cells");
        std::transform(more.begin(), more.end(), std::back_inserter(all),
                       [first](Index vertex) { return first + vertex; });
    }

    void add_data(std::vector<DataArray>& all, const Soup& piece, const std::vector<DataArray>& more) const {
        const auto same_kind = [](const DataArray& a, const DataArray& b) {
            return a.name == b.name && a.components == b.components && a.values.index() == b.values.index();
        };
        if (!std::equal(all.begin(), all.end(), more.begin(), more.end(), same_kind)) {
            fail(piece,
                 "its arrays differ from those of the pieces before in name, type, components or order");
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].append(more[i]);
        }
    }

    std::string path_;
    Soup all_;
};

// --- what several pieces have ---

using Numbers = IntegerList;

/// The array of integers with a name, one per row.
const Numbers* numbers_called(const std::vector<DataArray>& arrays, const char* name) {
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const DataArray& array) {
        return array.name == name && array.components == 1;
    });
    return found == arrays.end() ? nullptr : std::get_if<Numbers>(&found->values);
}

/// The rows to keep, in order, and the new row of each old row.
struct Merge {
    Array<Index> rows;
    Array<Index> new_of;
};

/// Sorts rows by number and keeps one row per number.
Merge by_number(const Numbers& numbers) {
    Array<Index> order(numbers.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return numbers[a] < numbers[b]; });
    Merge merge;
    merge.new_of.resize(numbers.size());
    for (const Index row : order) {
        if (merge.rows.empty() || numbers[merge.rows.back()] != numbers[row]) {
            merge.rows.push_back(row);
        }
        merge.new_of[row] = static_cast<Index>(merge.rows.size() - 1);
    }
    return merge;
}

template<class Values>
void keep_rows(Values& values, const Array<Index>& rows, std::size_t width) {
    Values kept;
    kept.reserve(rows.size() * width);
    for (const Index row : rows) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * width);
        kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(width));
    }
    values = std::move(kept);
}

void keep_rows(std::vector<DataArray>& arrays, const Array<Index>& rows) {
    for (DataArray& array : arrays) {
        array.keep_rows(rows);
    }
}

void drop(std::vector<DataArray>& arrays, const char* name) {
    std::erase_if(arrays, [&](const DataArray& array) { return array.name == name; });
}

/// Drops numbers that only count the rows.
void drop_if_counting(std::vector<DataArray>& arrays, const char* name) {
    const Numbers* numbers = numbers_called(arrays, name);
    std::int64_t next = 0;
    if (numbers != nullptr && std::all_of(numbers->begin(), numbers->end(),
                                          [&](std::int64_t number) { return number == next++; })) {
        drop(arrays, name);
    }
}

void join_points(Soup& soup) {
    const Numbers* numbers = numbers_called(soup.point_data, global_points);
    if (numbers == nullptr) {
        return;
    }
    const Merge merge = by_number(*numbers);
    for (std::size_t row = 0; row < numbers->size(); ++row) {
        if (soup.points[row] != soup.points[merge.rows[merge.new_of[row]]]) {
            throw InputError(fmt::format("{}: two pieces have point {} ({}) in different places", soup.path,
                                         (*numbers)[row], global_points));
        }
    }
    for (SimplexBlock& block : soup.simplices) {
        std::transform(block.vertices.begin(), block.vertices.end(), block.vertices.begin(),
                       [&](Index vertex) { return merge.new_of[vertex]; });
    }
    keep_rows(soup.points, merge.rows, 1);
    keep_rows(soup.point_data, merge.rows);
}

constexpr const char* ghost_array = "vtkGhostType";

/// Cells that VTK's array does not mark as copies of other pieces' cells.
Array<Index> own_cells(const Soup& soup, std::size_t cells) {
    constexpr std::int64_t copy = 1;
    const Numbers* marks = numbers_called(soup.cell_data, ghost_array);
    Array<Index> own;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (marks == nullptr || ((*marks)[cell] & copy) == 0) {
            own.push_back(static_cast<Index>(cell));
        }
    }
    return own;
}

void keep_cells(Soup& soup, const Array<Index>& rows) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    if (soup.simplices[top].size(soup.top_dimension()) == rows.size() &&
        std::is_sorted(rows.begin(), rows.end())) {
        return;
    }
    keep_rows(soup.simplices[top].vertices, rows, top + 1);
    keep_rows(soup.cell_data, rows);
}

void join_cells(Soup& soup) {
    const int top = soup.top_dimension();
    keep_cells(soup, own_cells(soup, soup.simplices[static_cast<std::size_t>(top)].size(top)));
    if (const Numbers* numbers = numbers_called(soup.cell_data, global_cells)) {
        keep_cells(soup, by_number(*numbers).rows);
    }
}

} // namespace

Soup read_pvtu(const std::filesystem::path& path) {
    return read_pvtu(path, ReadOptions{});
}

Soup read_pvtu(const std::filesystem::path& path, const ReadOptions& options) {
    Pieces pieces{path.string()};
    std::set<std::string> seen;
    for (const std::string& source : pvtu_sources(path)) {
        if (source.empty() || readable(source) != source) {
            throw InputError(
                fmt::format("{}: the name \"{}\" of a piece is no file's", path.string(), readable(source)));
        }
        if (!seen.insert(source).second) {
            throw InputError(
                fmt::format("{}: the piece \"{}\" is named twice", path.string(), readable(source)));
        }
        pieces.add(
            read_vtu_piece(path.parent_path() / source, {.linear = options.linear, .patch_array = {}}));
    }
    Soup soup = std::move(pieces).joined();
    join_points(soup);
    join_cells(soup);
    if (soup.top_dimension() == 0) {
        throw InputError(fmt::format("{}: there are no cells", path.string()));
    }
    drop_if_counting(soup.point_data, global_points);
    drop_if_counting(soup.cell_data, global_cells);
    drop(soup.point_data, ghost_array);
    drop(soup.cell_data, ghost_array);
    settle_equal_cells(soup, options.patch_array);
    return soup;
}

} // namespace slabhull::io
