// SPDX-License-Identifier: BSD-3-Clause
// Hulls and fillings from files, and hulls to files of any format.
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/filling.h"
#include "python/hull.h"
#include "python/long_call.h"
#include "python/mesh.h"
#include "python/write_options.h"

#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/core/error.h"
#include "slabhull/edit/soup_numbers.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/fill.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

namespace slabhull::python {

namespace {

/// A folder that vanishes with its files.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "slabhull-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw OutputError{fmt::format("{}: a folder for temporary files cannot be made", name)};
        }
        path_ = name;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

template<int D>
void write_as(const Hull<D>& hull, const std::filesystem::path& path, const std::string& format,
              const io::WriteOptions& options) {
    long_call([&] {
        io::AtomicFiles files;
        write_hull<D>(files, path, hull, format, options);
        files.commit();
    });
}

/// The hull as its VTU file has it.
template<int D>
io::Soup soup_of(const Hull<D>& hull) {
    const ScratchFolder scratch;
    const auto path = scratch.path() / "hull.vtu";
    write_as(hull, path, "vtu", {});
    return long_call([&] {
        io::Soup soup = io::read_vtu(path);
        settle_numbers(soup);
        return soup;
    });
}

void write_any(const SharedHull& self, const std::filesystem::path& path, const py::kwargs& named) {
    const NamedFormat chosen = format_from(path, named);
    const std::string name{chosen.format->name};
    std::visit(
        [&](const auto& hull) {
            if (name == "vtu" || name == "pvtu" || name == "msh") {
                io::require_supported(*chosen.format, chosen.options, "");
                write_as(*hull, path, name, chosen.options);
            } else {
                write_soup(soup_of(*hull), path, named);
            }
        },
        self.any());
}

SharedMesh as_mesh(const SharedHull& self) {
    return std::visit(
        [](const auto& hull) -> SharedMesh { return {std::make_shared<const io::Soup>(soup_of(*hull))}; },
        self.any());
}

// --- reading

/// The hull in a soup, whose arrays it takes.
template<int D>
Any<Hull> sound_hull(io::Soup& soup) {
    const std::string path = soup.path;
    const HullArrays<D> arrays = hull_of_soup<D>(soup);
    const HullColumns<D> columns = arrays.columns();
    const HullReport report = check_hull<D>(columns);
    if (!report.clean()) {
        throw InputError{fmt::format("{}: the hull has {} defects, see slabhull.check(); the first: {}", path,
                                     report.total(), report.findings.front().text),
                         report.findings.front().entities};
    }
    auto hull = std::make_shared<Hull<D>>(hull_of_columns<D>(columns));
    read_slab_fields(soup, *hull);
    return std::shared_ptr<const Hull<D>>{std::move(hull)};
}

SharedHull read_hull(const std::filesystem::path& path) {
    return SharedHull{long_call([&] {
        io::Soup soup = io::read_mesh(path);
        const MeshKind kind = kind_of(soup);
        if (!kind.hull) {
            throw InputError{fmt::format("{}: a mesh in space, not the hull of a slab", path.string())};
        }
        return kind.dimension == 2 ? sound_hull<2>(soup) : sound_hull<3>(soup);
    })};
}

/// Numbers over the points of a soup; empty where there are none.
Array<std::int64_t> point_numbers(const io::Soup& mesh, const char* name) {
    Array<std::int64_t> numbers;
    if (const io::DataArray* data = mesh.find_point_data(name)) {
        if (const auto* list = std::get_if<IntegerList>(&data->values)) {
            numbers.assign(list->begin(), list->end());
        }
    }
    return numbers;
}

/// Tetrahedra of points (x, y, t).
io::SpaceTimeSoup space_time_of(const io::Soup& mesh) {
    const MeshArrays<3> arrays = mesh_of_soup<3>(mesh);
    io::SpaceTimeSoup soup;
    soup.path = mesh.path;
    soup.dimension = 3;
    for (const Point<3>& point : arrays.points) {
        soup.points.insert(soup.points.end(), point.begin(), point.end());
    }
    for (const Simplex<3>& cell : arrays.cells) {
        soup.cells.insert(soup.cells.end(), cell.begin(), cell.end());
    }
    soup.vertex_id = point_numbers(mesh, "vertex_id");
    soup.track_id = point_numbers(mesh, "track_id");
    return soup;
}

SharedFilling read_filling(const std::filesystem::path& path) {
    return long_call([&]() -> SharedFilling {
        io::SpaceTimeSoup soup =
            io::is_space_time_file(path) ? io::read_space_time(path) : space_time_of(io::read_mesh(path));
        if (soup.dimension == 3) {
            return {std::make_shared<const Filling<2>>(filling_to_write<2>(soup))};
        }
        return {std::make_shared<const Filling<3>>(filling_to_write<3>(soup))};
    });
}

/// "filling", "hull" or "mesh".
std::string kind_of_file(const std::filesystem::path& path) {
    return long_call([&]() -> std::string {
        if (io::is_space_time_file(path)) {
            return "filling";
        }
        const io::Soup soup = io::read_mesh(path);
        return soup.top_dimension() >= 2 && kind_of(soup).hull ? "hull" : "mesh";
    });
}

} // namespace

void bind_hull_files(py::module_& module) {
    module.def("read_hull", read_hull, py::arg("path"),
               "The Hull in a file. Raises InputError for one that is not sound.");
    module.def(
        "read_filling", read_filling, py::arg("path"),
        "The Filling in a file: MFEM, GetFEM, HDF5, or tetrahedra of points (x, y, t), whose facets get "
        "the attributes 1, 2 and 3 by time.");
    module.def("is_filling_file", &io::is_space_time_file, py::arg("path"));
    module.def("kind_of_file", kind_of_file, py::arg("path"), "\"hull\", \"filling\" or \"mesh\".");
    module.attr("Hull").attr("write") = py::cpp_function(
        write_any, py::name("write"), py::is_method(module.attr("Hull")), py::arg("path"),
        "Writes any format; options as those of `slabhull convert`: format, encoding, version, "
        "four_dimensional, pieces. What the format cannot hold is a warning.");
    module.attr("Hull").attr("to_mesh") =
        py::cpp_function(as_mesh, py::name("to_mesh"), py::is_method(module.attr("Hull")),
                         "A Mesh with the arrays of a hull's file; a copy.");
}

} // namespace slabhull::python
