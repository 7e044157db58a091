// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/column.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace slabhull::io {

/// A named array over the points or the cells of a soup, or of the whole file.
struct DataArray {
    std::string name;
    int components = 1;
    std::variant<Array<double>, IntegerList, std::vector<std::string>> values;

    /// Keeps those rows, in the order given.
    void keep_rows(std::span<const Index> kept);
    /// Adds the rows of an array of the same type and components.
    void append(const DataArray& more);
};

/// The simplices of one dimension in a file.
struct SimplexBlock {
    Array<Index> vertices;             ///< dimension + 1 per simplex, from 0
    std::vector<PatchNumber> physical; ///< group of each simplex, 0 for none; empty: all 0
    std::vector<std::int32_t> entity;  ///< geometric entity of each simplex; empty: all 0
    Array<std::int64_t> tags;          ///< the file's own numbers; empty: counted from 0

    std::size_t size(int dimension) const {
        return vertices.size() / static_cast<std::size_t>(dimension + 1);
    }
    std::int64_t tag(std::size_t i) const { return tags.empty() ? static_cast<std::int64_t>(i) : tags[i]; }
};

/// The content of a mesh file: points and simplices, with nothing derived or repaired.
struct Soup {
    std::string path;
    Array<Point<3>> points;                ///< always three coordinates
    Array<std::int64_t> point_tags;        ///< the file's own numbers; empty: counted from 0
    std::array<SimplexBlock, 4> simplices; ///< by dimension: vertices, lines, triangles, tetrahedra
    std::array<PatchList, 4> groups;       ///< physical groups by dimension; a name may be empty
    std::vector<DataArray> point_data;
    std::vector<DataArray> cell_data; ///< rows go with the simplices of top_dimension()
    std::vector<DataArray> field_data;
    /// What the reader changed or ignored; for a user to read, with the path.
    std::vector<std::string> remarks;

    std::int64_t point_tag(std::size_t i) const {
        return point_tags.empty() ? static_cast<std::int64_t>(i) : point_tags[i];
    }
    /// Largest dimension that has simplices.
    int top_dimension() const;
    const DataArray* find_point_data(const std::string& name) const;
    const DataArray* find_cell_data(const std::string& name) const;
    const DataArray* find_field_data(const std::string& name) const;
};

enum class Scalar { float64, int64, int32 };

/// A named column to be written; `Scalar` is its type in the file.
struct DataColumn {
    std::string name;
    Scalar type = Scalar::float64;
    std::variant<Column<double>, Column<std::int64_t>> values;
};

/// A mesh to be written, as columns, so that it is not copied.
struct MeshColumns {
    int dimension = 3;          ///< of the simplices: 1, 2 or 3
    Column<double> points;      ///< 3 components
    Column<std::int64_t> cells; ///< dimension + 1 components, from 0
    std::vector<DataColumn> point_data;
    std::vector<DataColumn> cell_data;
    std::vector<DataArray> field_data;

    /// Blocks of consecutive cells, each a group, for formats with physical groups. Empty: one group without
    /// a name.
    struct Group {
        std::size_t begin = 0;
        std::size_t end = 0;
        PatchNumber number = 0; ///< positive
        std::string name;
    };
    std::vector<Group> groups;

    /// Simplices of a lower dimension, such as those of a boundary, in groups of their own.
    struct Part {
        int dimension = 0;          ///< 0 .. that of the mesh - 1
        Column<std::int64_t> cells; ///< dimension + 1 components, from 0
        std::vector<Group> groups;
    };
    std::vector<Part> lower; ///< by descending dimension; most formats do not store them
};

/// A soup as a mesh to be written: a view of its arrays, which must outlive the columns. Only field data are
/// copied. The cells are those of top_dimension(). Each run of cells with one physical group is a group;
/// groups without cells are also listed. Texts over points or cells are left out.
MeshColumns columns_of(const Soup& soup);

} // namespace slabhull::io
