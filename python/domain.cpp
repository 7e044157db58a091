// SPDX-License-Identifier: BSD-3-Clause
#include "python/domain.h"

#include "python/long_call.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slabhull::python {

namespace {

/// {name: facets}: the patches are numbered from 1, in order.
template<int D>
void take_named_facets(const py::dict& named, DomainInput<D>& input) {
    for (const auto& [name, facets] : named) {
        const std::string text = py::str(name);
        const auto number = static_cast<PatchNumber>(input.patches.size() + 1);
        const auto rows = rows_from<Index, D>(facets, ("facets of " + text).c_str());
        input.facets.insert(input.facets.end(), rows.begin(), rows.end());
        input.facet_patch.insert(input.facet_patch.end(), rows.size(), number);
        input.patches.push_back({number, text});
    }
}

template<int D>
void take_facets(const py::object& facets, const py::object& patch, const py::dict& names,
                 DomainInput<D>& input) {
    if (py::isinstance<py::dict>(facets)) {
        if (!patch.is_none() || !names.empty()) {
            throw UsageError{"facets: a dict {name: facets} names the patches, so facet_patch and patches "
                             "must not be given"};
        }
        return take_named_facets<D>(facets.cast<py::dict>(), input);
    }
    input.patches = patches_from(names);
    if (facets.is_none()) {
        return;
    }
    input.facets = rows_from<Index, D>(facets, "facets");
    if (patch.is_none()) {
        throw UsageError{"facet_patch: expected the patch of each of the facets"};
    }
    const Array<PatchNumber> numbers = list_from<PatchNumber>(patch, "facet_patch");
    input.facet_patch.assign(numbers.begin(), numbers.end());
}

StartDomain domain_of_arrays(const py::object& points, const py::object& cells, const py::object& facets,
                             const py::object& facet_patch, const py::dict& patches,
                             const py::object& cell_group, const std::string& where) {
    return with_dimension(static_cast<int>(width_of(points, "points")), [&](auto d) -> StartDomain {
        constexpr int D = d();
        DomainInput<D> input;
        input.points = rows_from<double, D>(points, "points");
        input.cells = rows_from<Index, D + 1>(cells, "cells");
        take_facets<D>(facets, facet_patch, patches, input);
        if (!cell_group.is_none()) {
            const auto groups = list_from<std::int32_t>(cell_group, "cell_group");
            input.cell_group.assign(groups.begin(), groups.end());
        }
        input.where = where;
        return {
            long_call([&] { return std::make_shared<const Domain<D>>(make_domain<D>(std::move(input))); })};
    });
}

void bind_cap(py::module_& module) {
    const auto array = [](auto member) {
        return [member](const Cap& self) {
            return std::visit([&](const auto& mesh) { return member(*mesh, Owner{mesh}); }, self.mesh);
        };
    };
    py::class_<Cap>(module, "SpatialMesh",
                    "A mesh of the domain at an instant. Its arrays are read-only views, without a copy.")
        .def_property_readonly(
            "dimension", [](const Cap& self) { return dimension_of(self.mesh); }, "D, that of space.")
        .def_property_readonly("points", array([](const auto& m, Owner o) { return rows_of(m.points, o); }),
                               "(n, D). A view.")
        .def_property_readonly("cells", array([](const auto& m, Owner o) { return rows_of(m.cells, o); }),
                               "(m, D + 1) uint32, positively oriented. A view.")
        .def_property_readonly(
            "neighbors", array([](const auto& m, Owner o) { return neighbors_of(m.neighbors, o); }),
            "(m, D + 1) int32, the cell opposite to each vertex, -1 across the boundary. A view.")
        .def_property_readonly("boundary_facets",
                               array([](const auto& m, Owner o) { return rows_of(m.boundary_facets, o); }),
                               "(k, D) uint32, outward. A view.")
        .def_property_readonly("boundary_patch", array([](const auto& m, Owner o) {
                                   return list_of(std::span{m.boundary_patch}, o);
                               }),
                               "The patch of each boundary facet. A view.")
        .def_property_readonly(
            "vertex_ids", array([](const auto& m, Owner o) { return list_of(std::span{m.vertex_ids}, o); }),
            "Persistent ids, int64. A view.")
        .def_property_readonly(
            "track_ids", array([](const auto& m, Owner o) { return list_of(std::span{m.track_ids}, o); }),
            "Tracks, int64, -1 for none. A view.")
        .def_property_readonly("patches",
                               array([](const auto& m, const Owner&) { return as_dict(m.patches); }),
                               "{number: name}");
}

} // namespace

Cap StartDomain::mesh() const {
    return std::visit(
        []<int D>(const std::shared_ptr<const Domain<D>>& shared) -> Cap {
            return {std::shared_ptr<const SpatialMesh<D>>{shared, &shared->mesh}};
        },
        domain);
}

void bind_domain(py::module_& module) {
    bind_cap(module);
    py::class_<StartDomain>(module, "Domain",
                            "A checked, oriented and numbered domain that marches start from.")
        .def(
            py::init(&domain_of_arrays), py::arg("points"), py::arg("cells"), py::arg("facets") = py::none(),
            py::arg("facet_patch") = py::none(), py::arg("patches") = py::dict{}, py::kw_only(),
            py::arg("cell_group") = py::none(), py::arg("where") = "domain",
            "From arrays, which are copied: points (n, D), cells (m, D + 1) by point numbers from 0, and the "
            "boundary facets (k, D) that belong to patches, either {name: facets}, or facets with the patch "
            "number of each and the names {number: name}. Other boundary facets become the patch "
            "\"boundary\". Raises InputError naming points, cells and facets at fault.")
        .def_property_readonly(
            "dimension", [](const StartDomain& self) { return dimension_of(self.domain); },
            "D, that of space.")
        .def_property_readonly("mesh", &StartDomain::mesh, "The SpatialMesh.")
        .def_property_readonly(
            "facets_without_patch",
            [](const StartDomain& self) {
                return std::visit([](const auto& domain) { return domain->facets_without_patch; },
                                  self.domain);
            },
            "Number of boundary facets that became the patch \"boundary\".");
}

} // namespace slabhull::python
