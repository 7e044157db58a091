// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_pieces.h"

#include "core/pieces.h"
#include "io/mesh/column_stream.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace slabhull::io {

namespace {

using Points = std::shared_ptr<const PointSet>;

/// The rows of a column that belong to a piece's points, filled by runs of consecutive points.
template<class T>
Column<T> of_points(const Column<T>& all, const Points& points) {
    const auto width = static_cast<std::size_t>(all.components());
    return {points->size(), all.components(),
            [all, points, width](std::size_t begin, std::size_t end, T* out) {
                std::size_t point = begin < end ? points->member(begin) : 0;
                while (begin < end) {
                    const std::size_t first = point;
                    std::size_t run = 1;
                    for (; begin + run < end && (point = points->next(point)) == first + run; ++run) {
                    }
                    all.fill(first, first + run, out);
                    out += run * width;
                    begin += run;
                }
            }};
}

template<class T>
Column<T> of_cells(const Column<T>& all, std::size_t first, std::size_t count) {
    return {count, all.components(), [all, first](std::size_t begin, std::size_t end, T* out) {
                all.fill(first + begin, first + end, out);
            }};
}

/// Cells with points numbered as in the piece instead of as in the mesh.
Column<std::int64_t> renumbered(const Column<std::int64_t>& cells, const Points& points) {
    const auto width = static_cast<std::size_t>(cells.components());
    return {cells.rows(), cells.components(),
            [cells, points, width](std::size_t begin, std::size_t end, std::int64_t* out) {
                cells.fill(begin, end, out);
                std::transform(out, out + (end - begin) * width, out, [&](std::int64_t point) {
                    return static_cast<std::int64_t>(points->rank(static_cast<std::size_t>(point)));
                });
            }};
}

template<class Pick>
std::vector<DataColumn> picked(const std::vector<DataColumn>& all, const Pick& pick) {
    std::vector<DataColumn> result;
    for (const DataColumn& data : all) {
        DataColumn part{data.name, data.type, {}};
        std::visit([&](const auto& column) { part.values = pick(column); }, data.values);
        result.push_back(std::move(part));
    }
    return result;
}

DataColumn numbers(const char* name, std::size_t rows, Column<std::int64_t>::Fill fill) {
    return {name, Scalar::int64, Column<std::int64_t>{rows, 1, std::move(fill)}};
}

DataColumn numbers_of(const Points& points) {
    return numbers(global_points, points->size(),
                   [points](std::size_t begin, std::size_t end, std::int64_t* out) {
                       std::size_t point = begin < end ? points->member(begin) : 0;
                       for (; begin < end; ++begin) {
                           *out++ = static_cast<std::int64_t>(point);
                           point = begin + 1 < end ? points->next(point) : point;
                       }
                   });
}

DataColumn numbers_from(std::size_t first, std::size_t count) {
    return numbers(global_cells, count, [first](std::size_t begin, std::size_t end, std::int64_t* out) {
        for (std::size_t cell = first + begin; cell < first + end; ++cell) {
            *out++ = static_cast<std::int64_t>(cell);
        }
    });
}

void add_global_numbers(MeshPiece& piece) {
    piece.mesh.point_data.push_back(numbers_of(piece.points));
    piece.mesh.cell_data.push_back(numbers_from(piece.first_cell, piece.mesh.cells.rows()));
}

std::vector<MeshColumns::Group> groups_within(const std::vector<MeshColumns::Group>& all, std::size_t first,
                                              std::size_t last) {
    std::vector<MeshColumns::Group> groups;
    for (MeshColumns::Group group : all) {
        group.begin = std::clamp(group.begin, first, last) - first;
        group.end = std::clamp(group.end, first, last) - first;
        if (group.begin < group.end) {
            groups.push_back(std::move(group));
        }
    }
    return groups;
}

std::vector<MeshColumns::Group> groups_of_members(std::vector<MeshColumns::Group> groups,
                                                  const PointSet& members) {
    for (MeshColumns::Group& group : groups) {
        group.begin = members.rank(group.begin);
        group.end = members.rank(group.end);
    }
    std::erase_if(groups, [](const MeshColumns::Group& group) { return group.begin == group.end; });
    return groups;
}

/// A given array with the name of ours would be confused with it.
void require_no_global_numbers(const MeshColumns& mesh) {
    for (const auto* arrays : {&mesh.point_data, &mesh.cell_data}) {
        for (const DataColumn& data : *arrays) {
            if (data.name == global_points || data.name == global_cells) {
                throw FormatLimit{fmt::format("a mesh with data called \"{}\" cannot be written in pieces, "
                                              "which have numbers of that name",
                                              data.name)};
            }
        }
    }
}

} // namespace

std::string global_ids_attribute(const std::vector<DataColumn>& data) {
    for (const DataColumn& column : data) {
        if (column.name == global_points || column.name == global_cells) {
            return fmt::format(" GlobalIds=\"{}\"", column.name);
        }
    }
    return {};
}

MeshPiece mesh_piece(const PieceColumns& columns) {
    require_no_global_numbers(columns.mesh);
    MeshPiece piece{columns.mesh, columns.first_cell, columns.points, {}};
    add_global_numbers(piece);
    piece.mesh.groups =
        groups_within(columns.groups, columns.first_cell, columns.first_cell + piece.mesh.cells.rows());
    return piece;
}

MeshPieces::MeshPieces(const MeshColumns& mesh, std::size_t pieces)
    : mesh_{mesh}, pieces_{pieces}, used_{mesh.points.rows()} {
    if (pieces < 1 || pieces > mesh.cells.rows()) {
        throw UsageError{fmt::format("{} pieces cannot be made of {} cells: expected 1 to {}", pieces,
                                     mesh.cells.rows(), mesh.cells.rows())};
    }
    require_no_global_numbers(mesh);
    for (const MeshColumns::Part& part : mesh.lower) {
        taken_.emplace_back(part.cells.rows());
    }
}

std::size_t MeshPieces::first_cell(std::size_t piece) const {
    return begin_of_part(mesh_.cells.rows(), piece, pieces_);
}

/// Chooses a piece's lower simplices. In the last piece also adds the points of those that are left.
std::shared_ptr<const PointSet> MeshPieces::choose_lower(std::size_t part, PointSet& points) {
    const Column<std::int64_t>& cells = mesh_.lower[part].cells;
    auto chosen = std::make_shared<PointSet>(cells.rows());
    for_each_row(cells, 0, cells.rows(), [&](std::size_t cell, const std::int64_t* vertices) {
        const std::int64_t* end = vertices + cells.components();
        const auto here = [&](std::int64_t vertex) {
            return points.contains(static_cast<std::size_t>(vertex));
        };
        if (!taken_[part].contains(cell) && (at_end() || std::all_of(vertices, end, here))) {
            chosen->insert(cell);
            std::for_each(vertices, end,
                          [&](std::int64_t vertex) { points.insert(static_cast<std::size_t>(vertex)); });
        }
    });
    taken_[part].insert(*chosen);
    chosen->count();
    return chosen;
}

MeshPiece MeshPieces::next() {
    const std::size_t first = first_cell(next_);
    const std::size_t count = first_cell(++next_) - first;
    auto points = std::make_shared<PointSet>(mesh_.points.rows());
    for_each_row(mesh_.cells, first, first + count, [&](std::size_t, const std::int64_t* vertices) {
        for (int k = 0; k <= mesh_.dimension; ++k) {
            points->insert(static_cast<std::size_t>(vertices[k]));
        }
    });
    MeshPiece piece{{}, first, points, {}};
    for (std::size_t part = 0; part < mesh_.lower.size(); ++part) {
        piece.lower.push_back(choose_lower(part, *points));
    }
    used_.insert(*points);
    if (at_end()) {
        points->insert_complement(used_);
    }
    points->count();
    const auto cells = [&](const auto& column) { return of_cells(column, first, count); };

    piece.mesh.dimension = mesh_.dimension;
    piece.mesh.points = of_points(mesh_.points, piece.points);
    piece.mesh.cells = renumbered(cells(mesh_.cells), piece.points);
    piece.mesh.point_data =
        picked(mesh_.point_data, [&](const auto& column) { return of_points(column, piece.points); });
    piece.mesh.cell_data = picked(mesh_.cell_data, cells);
    add_global_numbers(piece);
    piece.mesh.field_data = mesh_.field_data;
    piece.mesh.groups = groups_within(mesh_.groups, first, first + count);
    for (std::size_t part = 0; part < mesh_.lower.size(); ++part) {
        const MeshColumns::Part& all = mesh_.lower[part];
        piece.mesh.lower.push_back({all.dimension,
                                    renumbered(of_points(all.cells, piece.lower[part]), piece.points),
                                    groups_of_members(all.groups, *piece.lower[part])});
    }
    return piece;
}

std::filesystem::path piece_path(const std::filesystem::path& whole, std::size_t piece,
                                 const char* extension) {
    auto name = whole.stem();
    name += fmt::format("_{}{}", piece, extension);
    return whole.parent_path() / name;
}

} // namespace slabhull::io
