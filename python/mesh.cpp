// SPDX-License-Identifier: BSD-3-Clause
#include "python/mesh.h"

#include "python/arrays.h"
#include "python/long_call.h"
#include "python/write_options.h"

#include "slabhull/core/error.h"
#include "slabhull/edit/soup_numbers.h"
#include "slabhull/edit/soup_output.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace slabhull::python {

namespace {

// --- from Python

io::DataArray data_from(const std::string& name, const py::handle& values) {
    const py::array array = py::array::ensure(values);
    if (!array || array.ndim() < 1 || array.ndim() > 2) {
        throw UsageError{fmt::format("{}: expected an array with one or two axes", name)};
    }
    io::DataArray data{name, array.ndim() == 2 ? static_cast<int>(array.shape(1)) : 1, {}};
    const py::object flat = array.attr("reshape")(-1);
    if (array.dtype().kind() == 'f') {
        data.values = list_from<double>(flat, name.c_str());
    } else {
        data.values = IntegerList{list_from<std::int64_t>(flat, name.c_str())};
    }
    return data;
}

std::vector<io::DataArray> all_data_from(const py::dict& named) {
    std::vector<io::DataArray> all;
    for (const auto& [name, values] : named) {
        all.push_back(data_from(py::str(name), values));
    }
    return all;
}

void require_rows(const std::vector<io::DataArray>& arrays, std::size_t rows, const char* of) {
    for (const io::DataArray& array : arrays) {
        const std::size_t size = std::visit([](const auto& values) { return values.size(); }, array.values);
        if (size != rows * static_cast<std::size_t>(array.components)) {
            throw UsageError{fmt::format("{}: {} numbers for {} {}", array.name, size, rows, of)};
        }
    }
}

Array<Point<3>> points_from(const py::object& points) {
    if (width_of(points, "points") == 3) {
        return rows_from<double, 3>(points, "points");
    }
    Array<Point<3>> flat;
    for (const Point<2>& point : rows_from<double, 2>(points, "points")) {
        flat.push_back({point[0], point[1], 0});
    }
    return flat;
}

template<std::size_t N>
void take_cells(const py::object& cells, io::Soup& soup) {
    for (const auto& cell : rows_from<Index, N>(cells, "cells")) {
        for (const Index v : cell) {
            if (v >= soup.points.size()) {
                throw UsageError{fmt::format("cells: there is no point {}", v)};
            }
            soup.simplices[N - 1].vertices.push_back(v);
        }
    }
}

void take_cells(const py::object& cells, io::Soup& soup) {
    switch (width_of(cells, "cells")) {
    case 1:
        return take_cells<1>(cells, soup);
    case 2:
        return take_cells<2>(cells, soup);
    case 3:
        return take_cells<3>(cells, soup);
    case 4:
        return take_cells<4>(cells, soup);
    default:
        throw UsageError{"cells: expected simplices of one to four vertices"};
    }
}

SharedMesh mesh_of_arrays(const py::object& points, const py::object& cells, const py::dict& point_data,
                          const py::dict& cell_data, const py::object& cell_groups, const py::dict& groups) {
    io::Soup soup;
    soup.path = "mesh";
    soup.points = points_from(points);
    take_cells(cells, soup);
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    soup.groups[top] = patches_from(groups);
    soup.point_data = all_data_from(point_data);
    soup.cell_data = all_data_from(cell_data);
    require_rows(soup.point_data, soup.points.size(), "points");
    require_rows(soup.cell_data, soup.simplices[top].size(static_cast<int>(top)), "cells");
    if (!cell_groups.is_none()) {
        const auto numbers = list_from<PatchNumber>(cell_groups, "cell_groups");
        if (numbers.size() != soup.simplices[top].size(static_cast<int>(top))) {
            throw UsageError{fmt::format("cell_groups: {} numbers for {} cells", numbers.size(),
                                         soup.simplices[top].size(static_cast<int>(top)))};
        }
        soup.simplices[top].physical.assign(numbers.begin(), numbers.end());
    }
    return {std::make_shared<const io::Soup>(std::move(soup))};
}

// --- to Python

py::object shown(const io::DataArray& data, const Owner& owner) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&data.values)) {
        return py::cast(*texts);
    }
    const auto* reals = std::get_if<Array<double>>(&data.values);
    py::array flat = reals != nullptr ? list_of(std::span<const double>{*reals}, owner)
                                      : integers_of(std::get<IntegerList>(data.values));
    return data.components == 1 ? flat : flat.attr("reshape")(-1, data.components);
}

py::dict all_shown(const std::vector<io::DataArray>& arrays, const Owner& owner) {
    py::dict all;
    for (const io::DataArray& array : arrays) {
        all[py::str(array.name)] = shown(array, owner);
    }
    return all;
}

py::array cells_of(const SharedMesh& self, int dimension) {
    if (dimension < 0 || dimension > 3) {
        throw UsageError{fmt::format("simplices have a dimension from 0 to 3, not {}", dimension)};
    }
    const auto& vertices = self.soup->simplices[static_cast<std::size_t>(dimension)].vertices;
    const py::ssize_t width = dimension + 1;
    return view_of(py::dtype::of<Index>(), {static_cast<py::ssize_t>(vertices.size()) / width, width},
                   vertices.data(), self.soup);
}

/// Group of each simplex of a dimension; 0 for none.
py::array groups_of(const SharedMesh& self, int dimension) {
    const auto cells = static_cast<std::size_t>(cells_of(self, dimension).shape(0));
    const auto& physical = self.soup->simplices[static_cast<std::size_t>(dimension)].physical;
    if (!physical.empty()) {
        return list_of(std::span<const PatchNumber>{physical}, self.soup);
    }
    Array<PatchNumber> none;
    none.assign(cells, 0);
    return given_to_numpy(std::move(none));
}

py::dict names_of_groups(const SharedMesh& self) {
    py::dict all;
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
        if (!self.soup->groups[dimension].empty()) {
            all[py::int_(dimension)] = as_dict(self.soup->groups[dimension]);
        }
    }
    return all;
}

SharedMesh read(const std::filesystem::path& path, bool linear, const std::string& patch_array) {
    return {long_call([&] {
        auto soup = std::make_shared<io::Soup>(io::read_mesh(path, {linear, patch_array}));
        settle_numbers(*soup);
        return std::shared_ptr<const io::Soup>{std::move(soup)};
    })};
}

void warn_of_losses(const std::filesystem::path& path, const io::Format& format,
                    const std::vector<std::string>& lost) {
    if (lost.empty()) {
        return;
    }
    const std::string text =
        fmt::format("{}: {} does not hold: {}", path.string(), format.title, fmt::join(lost, "; "));
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) {
        throw py::error_already_set{};
    }
}

void require_dimension(const io::Soup& soup, const io::Format& format, const std::filesystem::path& path) {
    const int dimension = soup.top_dimension();
    if (dimension < format.features.min_dimension || dimension > format.features.max_dimension) {
        throw UsageError{fmt::format("{}: {} has no place for simplices of dimension {}", path.string(),
                                     format.title, dimension)};
    }
}

} // namespace

void write_soup(io::Soup soup, const std::filesystem::path& path, const py::kwargs& named) {
    const NamedFormat chosen = format_from(path, named);
    const io::Format& format = *chosen.format;
    io::require_supported(format, chosen.options, "");
    require_dimension(soup, format, path);
    settle_groups(format, soup);
    warn_of_losses(path, format, io::losses(format, soup, chosen.options));
    long_call([&] {
        if (format.features.one_based_tags) {
            number_by_tags(soup);
        }
        io::AtomicFiles files;
        format.write(files, path, columns_to_write(soup), chosen.options);
        files.commit();
    });
}

void bind_mesh(py::module_& module) {
    py::class_<SharedMesh>(
        module, "Mesh",
        "Simplices, data and groups, as a file of any format has them. Points and simplices "
        "are read-only views.")
        .def(py::init(&mesh_of_arrays), py::arg("points"), py::arg("cells"),
             py::arg("point_data") = py::dict{}, py::arg("cell_data") = py::dict{},
             py::arg("cell_groups") = py::none(), py::arg("groups") = py::dict{},
             "From arrays, which are copied; cell_groups: a number for each cell, groups: {number: name}.")
        .def_property_readonly(
            "dimension", [](const SharedMesh& self) { return self.soup->top_dimension(); }, "Of its cells.")
        .def_property_readonly(
            "points", [](const SharedMesh& self) { return rows_of(self.soup->points, self.soup); }, "(n, 3)")
        .def_property_readonly(
            "cells", [](const SharedMesh& self) { return cells_of(self, self.soup->top_dimension()); },
            "The simplices of the top dimension.")
        .def("simplices", cells_of, py::arg("dimension"), "Those of a dimension, 0 to 3.")
        .def("simplex_groups", groups_of, py::arg("dimension"), "The group of each of these; 0 for none.")
        .def_property_readonly("groups", names_of_groups, "{dimension: {number: name}}")
        .def_property_readonly(
            "point_data", [](const SharedMesh& self) { return all_shown(self.soup->point_data, self.soup); },
            "{name: array} over points.")
        .def_property_readonly(
            "cell_data", [](const SharedMesh& self) { return all_shown(self.soup->cell_data, self.soup); },
            "{name: array} over the simplices of the top dimension.")
        .def_property_readonly(
            "field_data", [](const SharedMesh& self) { return all_shown(self.soup->field_data, self.soup); },
            "{name: array} of the mesh as a whole.")
        .def_property_readonly(
            "remarks", [](const SharedMesh& self) { return self.soup->remarks; },
            "What the reader changed or ignored.")
        .def(
            "write",
            [](const SharedMesh& self, const std::filesystem::path& path, const py::kwargs& options) {
                write_soup(*self.soup, path, options);
            },
            py::arg("path"),
            "Writes any format; options as those of `slabhull convert`: format, encoding, version, "
            "four_dimensional, pieces. What the format cannot hold is a warning.");
    module.def("read_mesh", read, py::arg("path"), py::arg("linear") = false, py::arg("patch_array") = "",
               "The Mesh in a file of any format.");
}

} // namespace slabhull::python
