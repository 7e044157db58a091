// SPDX-License-Identifier: BSD-3-Clause
// Sections of hulls and fillings at an instant.
#include "python/any.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/filling.h"
#include "python/hull.h"
#include "python/long_call.h"

#include "slabhull/cases/hull_files.h"
#include "slabhull/slab/slice.h"
#include "slabhull/slab/slice_filling.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace slabhull::python {

namespace {

// --- of hulls: the domain's boundary

struct SharedSection {
    Any<Section> section;
    SectionReport report;
};

template<int D>
SharedSection share(Section<D>&& section) {
    SectionReport report = measure_section(section);
    return {std::make_shared<const Section<D>>(std::move(section)), std::move(report)};
}

std::vector<SharedSection> slice_shared_hull(const SharedHull& hull, const std::vector<double>& times) {
    return std::visit(
        [&]<int D>(const std::shared_ptr<const Hull<D>>& shared) {
            return long_call([&] {
                std::vector<SharedSection> sections;
                slice_hull<D>(columns_of(*shared), times,
                              [&](Section<D>&& section) { sections.push_back(share(std::move(section))); });
                return sections;
            });
        },
        hull.any());
}

template<class Any, class Write>
void write_one(const Any& any, const std::filesystem::path& path, const Write& write) {
    std::visit(
        [&](const auto& shared) {
            long_call([&] {
                io::AtomicFile file{path};
                write(file, *shared);
                file.commit();
            });
        },
        any);
}

void write(const SharedSection& self, const std::filesystem::path& path) {
    write_one(self.section, path, [](io::AtomicFile& file, const auto& s) { write_section(file, s); });
}

/// {name: measure}
py::dict measures_by_patch(const SharedSection& self) {
    return std::visit(
        [&](const auto& section) {
            py::dict all;
            for (const PatchMeasure& patch : self.report.patches) {
                all[py::str(patch_name(section->surface.patches, patch.number))] = patch.measure;
            }
            return all;
        },
        self.section);
}

template<class Read>
auto of_section(Read read) {
    return [read](const SharedSection& self) {
        return std::visit([&](const auto& section) { return read(*section, Owner{section}); }, self.section);
    };
}

void bind_section(py::module_& module) {
    py::class_<SharedSection>(module, "Section",
                              "The domain's closed boundary at an instant. Arrays are read-only views.")
        .def_property_readonly(
            "dimension", [](const SharedSection& self) { return dimension_of(self.section); },
            "D, that of space.")
        .def_property_readonly("time", of_section([](const auto& s, const Owner&) { return s.time; }),
                               "The instant.")
        .def_property_readonly(
            "points", of_section([](const auto& s, const Owner& o) { return rows_of(s.surface.points, o); }),
            "(n, D). A view.")
        .def_property_readonly(
            "facets", of_section([](const auto& s, const Owner& o) { return rows_of(s.surface.facets, o); }),
            "(m, D), outward from the domain.")
        .def_property_readonly("patch", of_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.surface.patch}, o);
                               }),
                               "The patch of each facet. A view.")
        .def_property_readonly("neighbors", of_section([](const auto& s, const Owner& o) {
                                   return neighbors_of(s.neighbors, o);
                               }),
                               "The cell opposite to each vertex, int32, -1 for none. A view.")
        .def_property_readonly("hull_cell", of_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.hull_cell}, o);
                               }),
                               "The cell of the hull that each facet is cut from. A view.")
        .def_property_readonly("vertex_ids", of_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.vertex_ids}, o);
                               }),
                               "The hull's vertex that the instant passes through, -1 for none.")
        .def_property_readonly("track_ids", of_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.track_ids}, o);
                               }),
                               "The track that each point is on, -1 for none.")
        .def_property_readonly(
            "patches", of_section([](const auto& s, const Owner&) { return as_dict(s.surface.patches); }),
            "{number: name}")
        .def_property_readonly(
            "measure", [](const SharedSection& self) { return self.report.measure; },
            "Length or area of the boundary.")
        .def_property_readonly(
            "enclosed", [](const SharedSection& self) { return self.report.enclosed; },
            "Area or volume of the domain.")
        .def_property_readonly(
            "components", [](const SharedSection& self) { return self.report.components; },
            "Number of closed curves or surfaces.")
        .def_property_readonly("measure_by_patch", measures_by_patch, "{name: length or area}")
        .def("write", &write, py::arg("path"), "Writes VTU.");
}

// --- of fillings: the domain's mesh

struct SharedFillingSection {
    Any<FillingSection> section;
    FillingSectionReport report;
};

SharedFillingSection slice_shared_filling(const SharedFilling& filling, double time) {
    return std::visit(
        [&]<int D>(const std::shared_ptr<const Filling<D>>& shared) -> SharedFillingSection {
            return long_call([&]() -> SharedFillingSection {
                auto section =
                    std::make_shared<const FillingSection<D>>(slice_filling<D>(columns_of(*shared), time));
                FillingSectionReport report = measure_section(*section);
                return {std::move(section), std::move(report)};
            });
        },
        filling.filling);
}

void write_with(const SharedFillingSection& self, const std::filesystem::path& path,
                const std::map<std::string, py::object>& solution) {
    std::vector<Array<double>> kept;
    std::vector<VertexValues> values;
    kept.reserve(solution.size());
    for (const auto& [name, numbers] : solution) {
        kept.push_back(list_from<double>(numbers, name.c_str()));
        values.push_back({name, kept.back()});
    }
    write_one(self.section, path,
              [&](io::AtomicFile& file, const auto& s) { write_section(file, s, values); });
}

/// Values of a function at a filling's vertices, at the section's points.
py::array value_at(const SharedFillingSection& self, const py::object& at_vertices) {
    const Array<double> values = list_from<double>(at_vertices, "at_vertices");
    return std::visit(
        [&](const auto& section) {
            Array<double> out;
            for (const PointOnEdge& point : section->edge) {
                if (point.lower >= values.size() || point.upper >= values.size()) {
                    throw UsageError{fmt::format("at_vertices: {} values are too few for vertex {}",
                                                 values.size(), std::max(point.lower, point.upper))};
                }
                out.push_back(point.value(values));
            }
            return given_to_numpy(std::move(out));
        },
        self.section);
}

template<class Read>
auto of_filling_section(Read read) {
    return [read](const SharedFillingSection& self) {
        return std::visit([&](const auto& section) { return read(*section, Owner{section}); }, self.section);
    };
}

void bind_filling_section(py::module_& module) {
    py::class_<SharedFillingSection>(module, "FillingSection",
                                     "The domain's mesh at an instant, cut out of a filling. Arrays are "
                                     "read-only views.")
        .def_property_readonly(
            "dimension", [](const SharedFillingSection& self) { return dimension_of(self.section); },
            "D, that of space.")
        .def_property_readonly("time", of_filling_section([](const auto& s, const Owner&) { return s.time; }),
                               "The instant.")
        .def_property_readonly(
            "points", of_filling_section([](const auto& s, const Owner& o) { return rows_of(s.points, o); }),
            "(n, D). A view.")
        .def_property_readonly(
            "cells", of_filling_section([](const auto& s, const Owner& o) { return rows_of(s.cells, o); }),
            "(m, D + 1) uint32, positively oriented. A view.")
        .def_property_readonly("neighbors", of_filling_section([](const auto& s, const Owner& o) {
                                   return neighbors_of(s.neighbors, o);
                               }),
                               "The cell opposite to each vertex, int32, -1 for none. A view.")
        .def_property_readonly("filling_cell", of_filling_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.filling_cell}, o);
                               }),
                               "The simplex of the filling that each cell is cut from. A view.")
        .def_property_readonly("boundary_facets", of_filling_section([](const auto& s, const Owner& o) {
                                   return rows_of(s.boundary_facets, o);
                               }),
                               "(k, D) uint32. A view.")
        .def_property_readonly("boundary_attribute", of_filling_section([](const auto& s, const Owner& o) {
                                   return list_of(std::span{s.boundary_attribute}, o);
                               }),
                               "The attribute of the filling's facet that each is cut from. A view.")
        .def_property_readonly(
            "measure", [](const SharedFillingSection& self) { return self.report.measure; },
            "Area or volume of the domain.")
        .def("value", value_at, py::arg("at_vertices"),
             "The values at the points of a function that is linear in each simplex, from its values at the "
             "filling's vertices.")
        .def("write", write_with, py::arg("path"), py::arg("solution") = std::map<std::string, py::object>{},
             "Writes VTU, with solutions {name: values at the filling's vertices} cut with the mesh.");
}

} // namespace

void bind_sections(py::module_& module) {
    bind_section(module);
    bind_filling_section(module);
    module.def("slice_hull", slice_shared_hull, py::arg("hull"), py::arg("times"));
    module.def("slice_filling", slice_shared_filling, py::arg("filling"), py::arg("time"));
}

} // namespace slabhull::python
