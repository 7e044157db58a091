// SPDX-License-Identifier: BSD-3-Clause
#include "hull_columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slabhull::bench {

namespace {

using io::Scalar;

/// Calls use(copy, begin, end) for each copy's part of rows [begin, end): what divides stays out of the
/// loops, which real hulls have not.
template<class Use>
void by_copy(std::size_t begin, std::size_t end, std::size_t rows_of_one, const Use& use) {
    while (begin < end) {
        const std::size_t copy = begin / rows_of_one;
        const std::size_t last = std::min(end, (copy + 1) * rows_of_one);
        use(copy, begin - copy * rows_of_one, last - copy * rows_of_one);
        begin = last;
    }
}

Column<double> points_of(const HullSoup& soup) {
    return {soup.point_count(), 3, [soup](std::size_t begin, std::size_t end, double* out) {
                by_copy(begin, end, soup.points_of_one,
                        [&](std::size_t copy, std::size_t first, std::size_t last) {
                            const double shift = 10 * static_cast<double>(copy);
                            for (std::size_t v = first; v < last; ++v) {
                                *out++ = soup.points[v][0] + shift;
                                *out++ = soup.points[v][1];
                                *out++ = soup.points[v][2];
                            }
                        });
            }};
}

/// `step` is what a copy adds to a number.
Column<std::int64_t> quads_of(const HullSoup& soup, const Quad* rows, std::size_t step) {
    return {soup.cell_count(), 4, [=](std::size_t begin, std::size_t end, std::int64_t* out) {
                by_copy(begin, end, soup.cells_of_one,
                        [&](std::size_t copy, std::size_t first, std::size_t last) {
                            const auto shift = static_cast<std::int64_t>(copy * step);
                            for (std::size_t c = first; c < last; ++c) {
                                for (const std::uint32_t value : rows[c]) {
                                    *out++ = value == UINT32_MAX ? -1 : value + shift;
                                }
                            }
                        });
            }};
}

template<class T, class Value>
Column<T> computed(std::size_t rows, const Value& value) {
    return {rows, 1, [value](std::size_t begin, std::size_t end, T* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    *out++ = static_cast<T>(value(row));
                }
            }};
}

Column<std::int64_t> cell_of_points(const HullSoup& soup) {
    return {soup.point_count(), 1, [soup](std::size_t begin, std::size_t end, std::int64_t* out) {
                by_copy(begin, end, soup.points_of_one,
                        [&](std::size_t copy, std::size_t first, std::size_t last) {
                            const auto shift = static_cast<std::int64_t>(copy * soup.cells_of_one);
                            out = std::transform(soup.cell_of + first, soup.cell_of + last, out,
                                                 [=](std::uint32_t cell) { return cell + shift; });
                        });
            }};
}

template<class T>
io::DataArray field(const char* name, Array<T> values) {
    return {name, 1, std::move(values)};
}

/// Whether the array holds value(row) in all rows and components.
template<class Value>
bool holds(const io::DataArray* array, std::size_t rows, int components, const Value& value) {
    if (array == nullptr || array->components != components) {
        return false;
    }
    return std::visit(
        [&](const auto& values) {
            using Stored = typename std::decay_t<decltype(values)>::value_type;
            if constexpr (std::is_arithmetic_v<Stored>) {
                bool right = values.size() == rows * static_cast<std::size_t>(components);
                for (std::size_t i = 0; right && i < values.size(); ++i) {
                    right = values[i] == static_cast<Stored>(value(i));
                }
                return right;
            }
            return false;
        },
        array->values);
}

} // namespace

io::MeshColumns mesh_columns(const HullSoup& soup) {
    io::MeshColumns mesh;
    mesh.points = points_of(soup);
    mesh.cells = quads_of(soup, soup.cells, soup.points_of_one);
    const auto begins = soup.begins();
    mesh.groups = {{begins[0], begins[1], 1, "group 1"},
                   {begins[1], begins[2], 2, "group 2"},
                   {begins[2], begins[3], 3, "group 3"}};
    return mesh;
}

io::MeshColumns hull_columns(const HullSoup& soup) {
    io::MeshColumns mesh = mesh_columns(soup);
    const std::size_t points = soup.point_count();
    const std::size_t cells = soup.cell_count();
    mesh.point_data = {
        {"t", Scalar::float64, computed<double>(points, [=](std::size_t v) { return soup.time(v); })},
        {"vertex_id", Scalar::int64,
         computed<std::int64_t>(points, [=](std::size_t v) { return soup.id(v); })},
        {"track_id", Scalar::int64,
         computed<std::int64_t>(points, [=](std::size_t v) { return soup.track(v); })},
        {"cell", Scalar::int64, cell_of_points(soup)}};
    mesh.cell_data = {
        {"region", Scalar::int32,
         computed<std::int64_t>(cells, [=](std::size_t c) { return soup.region(c); })},
        {"patch", Scalar::int32, computed<std::int64_t>(cells, [=](std::size_t c) { return soup.patch(c); })},
        {"layer", Scalar::int32, computed<std::int64_t>(cells, [=](std::size_t c) { return soup.layer(c); })},
        {"neighbors", Scalar::int64, quads_of(soup, soup.neighbors, soup.cells_of_one)}};
    mesh.field_data = {field<std::int64_t>("slab", {0}), field<double>("time", {0, 1}),
                       field<std::int64_t>("dimension", {3}), field<std::int64_t>("patch_number", {1})};
    mesh.field_data.push_back({"patch_name", 1, std::vector<std::string>{"body"}});
    return mesh;
}

bool is_mesh(const io::Soup& found, const HullSoup& soup, double tolerance) {
    const auto close = [=](double a, double b) { return std::abs(a - b) <= tolerance * std::abs(b); };
    bool right = found.points.size() == soup.point_count() && found.simplices[3].size(3) == soup.cell_count();
    for (std::size_t v = 0; right && v < soup.point_count(); ++v) {
        const Point<3> wanted = soup.point(v);
        right = std::equal(wanted.begin(), wanted.end(), found.points[v].begin(), close);
    }
    for (std::size_t c = 0; right && c < soup.cell_count(); ++c) {
        const auto vertices = soup.vertices(c);
        right = std::equal(vertices.begin(), vertices.end(), found.simplices[3].vertices.data() + 4 * c);
    }
    return right;
}

bool is_hull(const io::Soup& found, const HullSoup& soup) {
    const std::size_t points = soup.point_count();
    const std::size_t cells = soup.cell_count();
    const auto at_points = [&](const char* name, const auto& value) {
        return holds(found.find_point_data(name), points, 1, value);
    };
    const auto in_cells = [&](const char* name, const auto& value) {
        return holds(found.find_cell_data(name), cells, 1, value);
    };
    return is_mesh(found, soup) && at_points("t", [&](std::size_t v) { return soup.time(v); }) &&
           at_points("vertex_id", [&](std::size_t v) { return soup.id(v); }) &&
           at_points("track_id", [&](std::size_t v) { return soup.track(v); }) &&
           at_points("cell", [&](std::size_t v) { return soup.cell(v); }) &&
           in_cells("region", [&](std::size_t c) { return soup.region(c); }) &&
           in_cells("patch", [&](std::size_t c) { return soup.patch(c); }) &&
           in_cells("layer", [&](std::size_t c) { return soup.layer(c); }) &&
           holds(found.find_cell_data("neighbors"), cells, 4,
                 [&](std::size_t i) { return soup.across(i / 4)[i % 4]; });
}

} // namespace slabhull::bench
