// SPDX-License-Identifier: BSD-3-Clause
#include "python/filling.h"

#include "python/arrays.h"
#include "python/hull.h"
#include "python/long_call.h"
#include "python/march.h"

#include "slabhull/cases/filling_files.h"
#include "slabhull/slab/fill.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>

namespace slabhull::python {

namespace {

/// A filling made without the interpreter's lock.
template<class Make>
SharedFilling filled(const py::object& told, const Make& make) {
    return {long_call(told, [&] {
        using Made = decltype(make());
        return std::make_shared<const Made>(make());
    })};
}

SharedFilling fill_shared_slab(const SharedSlab& slab, const py::object& told) {
    return std::visit([&](const auto& shared) { return filled(told, [&] { return fill_slab(*shared); }); },
                      slab.any());
}

SharedFilling fill_shared_hull(const SharedHull& hull, const py::object& told) {
    return std::visit([&](const auto& shared) { return filled(told, [&] { return fill_slab(*shared); }); },
                      hull.any());
}

SharedFilling fill_by_tetgen(const SharedHull& hull, double time_scale, const py::object& told) {
    const auto& flat = of_dimension<2>(hull.any(), "filling by TetGen");
    return filled(told, [&] {
        StageClock clock;
        return fill_unstructured(*flat, clock, {time_scale});
    });
}

void write(const SharedFilling& self, const std::filesystem::path& path, const std::string& format,
           int pentatope_code) {
    std::visit(
        [&]<int D>(const std::shared_ptr<const Filling<D>>& filling) {
            long_call([&] {
                io::AtomicFiles files;
                write_filling<D>(files, path, *filling, filling_format(path, format, D), {pentatope_code});
                files.commit();
            });
        },
        self.filling);
}

template<class Read>
auto of_filling(Read read) {
    return [read](const SharedFilling& self) {
        return std::visit([&](const auto& filling) { return read(*filling, Owner{filling}); }, self.filling);
    };
}

template<int D>
std::string described(const Filling<D>& filling) {
    return fmt::format("<slabhull.Filling of slab {} in {}D+t: {} {}, {} points>", filling.slab, D,
                       filling.cells.size(), D == 2 ? "tetrahedra" : "pentatopes", filling.points.size());
}

using FillingClass = py::class_<SharedFilling>;

void bind_views(FillingClass& filling) {
    filling
        .def_property_readonly("points",
                               of_filling([](const auto& f, const Owner& o) { return rows_of(f.points, o); }),
                               "(n, D + 1), time last; the hull's come first. A view.")
        .def_property_readonly("cells",
                               of_filling([](const auto& f, const Owner& o) { return rows_of(f.cells, o); }),
                               "(m, D + 2) uint32, positive. A view.")
        .def_property_readonly("neighbors", of_filling([](const auto& f, const Owner& o) {
                                   return neighbors_of(f.neighbors, o);
                               }),
                               "(m, D + 2) int32, -1 across the hull. A view.")
        .def_property_readonly("facets",
                               of_filling([](const auto& f, const Owner& o) { return rows_of(f.facets, o); }),
                               "The hull's cells. A view.")
        .def_property_readonly("facet_attribute", of_filling([](const auto& f, const Owner& o) {
                                   return list_of(std::span{f.facet_attribute}, o);
                               }),
                               "1 initial cap, 2 terminating cap, 2 + patch on the side. A view.");
}

void bind_rest(FillingClass& filling) {
    filling
        .def_property_readonly(
            "dimension", [](const SharedFilling& self) { return dimension_of(self.filling); },
            "D, that of space; cells have D + 2 corners.")
        .def_property_readonly(
            "vertex_ids", of_filling([](const auto& f, const Owner&) { return integers_of(f.vertex_ids); }),
            "int64, -1 for vertices inside. Made at each call.")
        .def_property_readonly(
            "track_ids", of_filling([](const auto& f, const Owner&) { return integers_of(f.track_ids); }),
            "int64, -1 for none. Made at each call.")
        .def_property_readonly("patches",
                               of_filling([](const auto& f, const Owner&) { return as_dict(f.patches); }),
                               "{number: name}")
        .def_property_readonly("hull_points",
                               of_filling([](const auto& f, const Owner&) { return f.hull_points; }),
                               "How many points are the hull's; these come first.")
        .def_property_readonly("steiner_points",
                               of_filling([](const auto& f, const Owner&) { return f.steiner_points; }),
                               "How many points were put inside prisms and cavities.")
        .def_property_readonly("slab", of_filling([](const auto& f, const Owner&) { return f.slab; }),
                               "The number of the slab.")
        .def_property_readonly("time", of_filling([](const auto& f, const Owner&) {
                                   return std::make_pair(f.time[0], f.time[1]);
                               }),
                               "Start and end of the slab.")
        .def("write", &write, py::arg("path"), py::arg("format") = "",
             py::arg("pentatope_code") = io::usual_pentatope_code,
             "Writes MFEM, GetFEM or HDF5, in 2D+t also VTU or MSH, by extension or by name.")
        .def("__repr__", of_filling([](const auto& f, const Owner&) { return described(f); }));
}

} // namespace

void bind_filling(py::module_& module) {
    FillingClass filling{module, "Filling",
                         "A slab as a space-time mesh: tetrahedra in 2D+t, pentatopes in 3D+t. Arrays are "
                         "read-only and stay valid when the filling is gone."};
    bind_views(filling);
    bind_rest(filling);
    module.def("fill_slab", fill_shared_slab, py::arg("slab"), py::arg("on_progress"));
    module.def("fill_hull", fill_shared_hull, py::arg("hull"), py::arg("on_progress"));
    module.def("fill_by_tetgen", fill_by_tetgen, py::arg("hull"), py::arg("time_scale"),
               py::arg("on_progress"));
}

} // namespace slabhull::python
