// SPDX-License-Identifier: BSD-3-Clause
// Checks. They come out as (JSON text, findings, skipped, text), of which slabhull/report.py makes a Report.
#include "python/bindings.h"

#include "python/arrays.h"
#include "python/errors.h"
#include "python/filling.h"
#include "python/hull.h"
#include "python/long_call.h"

#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/check_filling.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

#include <limits>
#include <optional>
#include <string>

namespace slabhull::python {

namespace {

py::tuple told(const std::string& json, const CheckResult& result, const std::string& embedding = {}) {
    py::list findings;
    for (const Finding& finding : result.findings) {
        findings.append(
            py::make_tuple(std::string{defect_name(finding.what)}, as_list(finding.entities), finding.text));
    }
    return py::make_tuple(json, embedding, findings, result.skipped, result.total(),
                          findings_as_text(result));
}

/// A hull's check, and the proof that it does not cross itself.
struct HullCheck {
    HullReport report;
    std::optional<EmbeddingSummary> embedding;

    py::tuple told() const {
        return python::told(report_as_json(report), report, embedding ? report_as_json(*embedding) : "");
    }
};

template<int D>
HullCheck examine(const HullColumns<D>& columns, bool betti, bool embedding, CheckOptions options = {}) {
    options.betti_cells = betti ? std::numeric_limits<std::size_t>::max() : 0;
    HullCheck check{check_hull<D>(columns, options), std::nullopt};
    if (embedding) {
        check.embedding = check_embedding<D>(columns, options, check.report, false);
    }
    return check;
}

py::tuple check_shared_hull(const SharedHull& hull, bool betti, bool embedding) {
    const HullCheck check = std::visit(
        [&](const auto& shared) {
            return long_call([&] { return examine(columns_of(*shared), betti, embedding); });
        },
        hull.any());
    return check.told();
}

/// An optional claim about cells or points, and the memory behind its column.
struct Claim {
    Array<std::int64_t> values;
    Column<std::int64_t> column(int components = 1) const {
        return values.empty() ? Column<std::int64_t>{}
                              : Column<std::int64_t>::over(std::span<const std::int64_t>{values}, components);
    }
};

Claim claim_of(const py::dict& claims, const char* name) {
    if (!claims.contains(name) || claims[name].is_none()) {
        return {};
    }
    const py::object flat = py::array::ensure(claims[name]);
    return {list_from<std::int64_t>(flat ? flat.attr("reshape")(-1) : flat, name)};
}

template<int D>
py::tuple check_arrays_in(const py::object& points, const py::object& cells, const py::dict& claims,
                          bool betti, bool embedding) {
    const auto places = rows_from<double, D + 1>(points, "points");
    const auto simplices = rows_from<Index, D + 1>(cells, "cells");
    const Claim region = claim_of(claims, "region");
    const Claim patch = claim_of(claims, "patch");
    const Claim layer = claim_of(claims, "layer");
    const Claim neighbors = claim_of(claims, "neighbors");
    const Claim vertex_id = claim_of(claims, "vertex_ids");
    const Claim track_id = claim_of(claims, "track_ids");
    HullColumns<D> columns;
    columns.points = places;
    columns.cells = simplices;
    columns.region = region.column();
    columns.patch = patch.column();
    columns.layer = layer.column();
    columns.neighbors = neighbors.column(D + 1);
    columns.vertex_id = vertex_id.column();
    columns.track_id = track_id.column();
    return long_call([&] { return examine<D>(columns, betti, embedding); }).told();
}

py::tuple check_hull_arrays(const py::object& points, const py::object& cells, const py::dict& claims,
                            bool betti, bool embedding) {
    return with_dimension(static_cast<int>(width_of(points, "points")) - 1, [&](auto d) {
        return check_arrays_in<d()>(points, cells, claims, betti, embedding);
    });
}

py::tuple check_mesh_arrays(const py::object& points, const py::object& cells) {
    return with_dimension(static_cast<int>(width_of(points, "points")), [&](auto d) {
        constexpr int D = d();
        const auto places = rows_from<double, D>(points, "points");
        const auto simplices = rows_from<Index, D + 1>(cells, "cells");
        const MeshReport report = long_call([&] { return check_mesh<D>(places, simplices); });
        return told(report_as_json(report), report);
    });
}

/// A filling, compared with its hull if that is given.
py::tuple check_shared_filling(const SharedFilling& filling, const SharedHull* hull) {
    return std::visit(
        [&]<int D>(const std::shared_ptr<const Filling<D>>& shared) {
            const Hull<D>* compared =
                hull != nullptr ? of_dimension<D>(hull->any(), "the hull").get() : nullptr;
            const FillingReport report =
                long_call([&] { return check_filling<D>(columns_of(*shared), compared); });
            return told(report_as_json(report), report);
        },
        filling.filling);
}

/// Findings in a file's own numbers. The soup must outlive the options, and keep its tags.
CheckOptions numbered_as_in(const io::Soup& soup, std::size_t dimension) {
    CheckOptions options;
    if (!soup.point_tags.empty()) {
        options.vertex_number = [&soup](Index v) { return soup.point_tag(v); };
    }
    const io::SimplexBlock& block = soup.simplices[dimension];
    if (!block.tags.empty()) {
        options.cell_number = [&block](Index c) { return block.tag(c); };
    }
    return options;
}

/// A hull or a mesh as a file has it, sound or not.
template<int D>
py::tuple check_soup(io::Soup& soup, bool hull, bool betti, bool embedding) {
    const CheckOptions options = numbered_as_in(soup, D);
    if (hull) {
        const HullCheck check = long_call([&] {
            const HullArrays<D> arrays = hull_of_soup<D>(soup);
            return examine<D>(arrays.columns(), betti, embedding, options);
        });
        return check.told();
    }
    const MeshReport report = long_call([&] {
        const MeshArrays<D> mesh = mesh_of_soup<D>(soup);
        return check_mesh<D>(mesh.points, mesh.cells, options);
    });
    return told(report_as_json(report), report);
}

py::tuple check_file(const std::filesystem::path& path, bool betti, bool embedding) {
    io::Soup soup = long_call([&] { return io::read_mesh(path); });
    const MeshKind kind = kind_of(soup);
    return kind.dimension == 2 ? check_soup<2>(soup, kind.hull, betti, embedding)
                               : check_soup<3>(soup, kind.hull, betti, embedding);
}

} // namespace

void bind_check(py::module_& module) {
    module.def("check_hull", check_shared_hull, py::arg("hull"), py::arg("betti"), py::arg("embedding"));
    module.def("check_filling", check_shared_filling, py::arg("filling"), py::arg("hull"));
    module.def("check_file", check_file, py::arg("path"), py::arg("betti"), py::arg("embedding"));
    module.def("check_hull_arrays", check_hull_arrays, py::arg("points"), py::arg("cells"), py::arg("claims"),
               py::arg("betti"), py::arg("embedding"));
    module.def("check_mesh_arrays", check_mesh_arrays, py::arg("points"), py::arg("cells"));
}

} // namespace slabhull::python
