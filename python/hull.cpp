// SPDX-License-Identifier: BSD-3-Clause
#include "python/hull.h"

#include "slabhull/slab/hull_columns.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>

namespace slabhull::python {

namespace {

/// The values of a column as 32-bit integers, written without the 64-bit ones in between being kept.
py::array small_integers(const Column<std::int64_t>& column) {
    constexpr std::size_t at_once = 1 << 16;
    Array<std::int32_t> all(column.rows());
    std::vector<std::int64_t> piece(std::min(at_once, column.rows()));
    for (std::size_t begin = 0; begin < all.size(); begin += at_once) {
        const std::size_t end = std::min(all.size(), begin + at_once);
        column.fill(begin, end, piece.data());
        std::copy_n(piece.begin(), end - begin, all.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    return given_to_numpy(std::move(all));
}

/// A property that reads the hull.
template<class Read>
auto of_hull(Read read) {
    return [read](const SharedHull& self) {
        return std::visit([&](const auto& hull) { return read(*hull, Owner{hull}); }, self.any());
    };
}

/// A property that is made once.
template<class Make>
auto once(const char* name, Make make) {
    return [name, make](SharedHull& self) {
        return self.made_once(
            name, [&] { return std::visit([&](const auto& hull) { return make(*hull); }, self.any()); });
    };
}

template<int D>
std::string described(const Hull<D>& hull) {
    return fmt::format("<slabhull.Hull of slab {} in {}D+t, t = {} to {}: {} cells, {} points>", hull.slab, D,
                       hull.time[0], hull.time[1], hull.cells.size(), hull.points.size());
}

using HullClass = py::class_<SharedHull>;

void bind_views(HullClass& hull) {
    hull.def_property_readonly("points",
                               of_hull([](const auto& h, const Owner& o) { return rows_of(h.points, o); }),
                               "(n, D + 1), time last. A view.")
        .def_property_readonly("cells",
                               of_hull([](const auto& h, const Owner& o) { return rows_of(h.cells, o); }),
                               "(m, D + 1) uint32, outward. A view.")
        .def_property_readonly(
            "neighbors", of_hull([](const auto& h, const Owner& o) { return neighbors_of(h.neighbors, o); }),
            "(m, D + 1) int32: the cell across the facet opposite to each vertex. A view.")
        .def_property_readonly("facet_patch", of_hull([](const auto& h, const Owner& o) {
                                   return list_of(std::span{h.facet_patch}, o);
                               }),
                               "Patch of each boundary facet that is swept. A view.");
}

void bind_columns(HullClass& hull) {
    hull.def_property_readonly("region",
                               once("region", [](const auto& h) { return small_integers(region_column(h)); }),
                               "Of each cell: 0 initial cap, 1 side, 2 terminating cap. Made once.")
        .def_property_readonly("patch",
                               once("patch", [](const auto& h) { return small_integers(patch_column(h)); }),
                               "Of each cell; 0 in caps. Made once.")
        .def_property_readonly("layer",
                               once("layer", [](const auto& h) { return small_integers(layer_column(h)); }),
                               "Of each cell; -1 in caps. Made once.")
        .def_property_readonly("vertex_ids",
                               once("vertex_ids", [](const auto& h) { return integers_of(h.vertex_ids); }),
                               "Persistent ids, int64. Made once.")
        .def_property_readonly("track_ids",
                               once("track_ids", [](const auto& h) { return integers_of(h.track_ids); }),
                               "Tracks, int64, -1 for none. Made once.");
}

void bind_counts(HullClass& hull) {
    hull.def_property_readonly("dimension", &SharedHull::dimension, "D, that of space.")
        .def_property_readonly("slab", of_hull([](const auto& h, const Owner&) { return h.slab; }),
                               "The number of the slab.")
        .def_property_readonly(
            "time", of_hull([](const auto& h, const Owner&) { return std::make_pair(h.time[0], h.time[1]); }),
            "Start and end of the slab.")
        .def_property_readonly("layers", of_hull([](const auto& h, const Owner&) { return h.layers; }),
                               "The number of layers of the side.")
        .def_property_readonly("patches",
                               of_hull([](const auto& h, const Owner&) { return as_dict(h.patches); }),
                               "{number: name}")
        .def_property_readonly("initial_cells",
                               of_hull([](const auto& h, const Owner&) { return h.initial_cells; }),
                               "Number of cells of the initial cap, which come first.")
        .def_property_readonly("side_cells",
                               of_hull([](const auto& h, const Owner&) { return h.side_cells; }),
                               "Number of cells of the side, which come next.")
        .def_property_readonly("initial_points",
                               of_hull([](const auto& h, const Owner&) { return h.initial_points; }),
                               "Number of points of the initial cap, which come first.")
        .def_property_readonly("side_points",
                               of_hull([](const auto& h, const Owner&) { return h.side_points; }),
                               "Number of points that the side adds, which come next.")
        .def_property_readonly("cells_per_prism",
                               of_hull([](const auto& h, const Owner&) { return h.cells_per_prism; }),
                               "Simplices that a boundary facet leaves in each layer.")
        .def("__repr__", of_hull([](const auto& h, const Owner&) { return described(h); }));
}

} // namespace

py::array SharedHull::made_once(const std::string& name, const std::function<py::array()>& make) {
    const auto found = made_.find(name);
    return found != made_.end() ? found->second : made_.emplace(name, make()).first->second;
}

void bind_hull(py::module_& module) {
    HullClass hull{
        module, "Hull",
        "The closed boundary of a slab of space-time: triangles in 2D+t, tetrahedra in 3D+t. Cells "
        "are in the order initial cap, side, terminating cap. Arrays are read-only; they stay "
        "valid when the hull or its march is gone."};
    bind_views(hull);
    bind_columns(hull);
    bind_counts(hull);
}

} // namespace slabhull::python
