// SPDX-License-Identifier: BSD-3-Clause
// Cases: what a case file says, from a file or from text.
#include "python/bindings.h"
#include "python/domain.h"
#include "python/long_call.h"
#include "python/march.h"

#include "slabhull/cases/case.h"
#include "slabhull/cases/experiments.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/run.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/error.h"
#include "slabhull/io/files.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slabhull::python {

namespace {

/// The library's remarks, kept until Python can be told of them.
class Remarks {
public:
    Listener listener() {
        return {[this](const std::string& text) { texts_.push_back(text); }, [](const RunProgress&) {}};
    }
    /// As warnings of Python, which may be turned into exceptions.
    void warn() const {
        for (const std::string& text : texts_) {
            if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) {
                throw py::error_already_set{};
            }
        }
    }

private:
    std::vector<std::string> texts_;
};

StartDomain domain_of(const Case& the_case) {
    return with_dimension(the_case.dimension, [&](auto d) -> StartDomain {
        Remarks remarks;
        auto domain = long_call([&] {
            StageClock clock;
            return std::make_shared<const Domain<d()>>(
                initial_domain<d()>(the_case, {}, remarks.listener(), clock));
        });
        remarks.warn();
        return {std::move(domain)};
    });
}

SharedMarch march_of(const Case& the_case) {
    return std::visit(
        [&]<int D>(const std::shared_ptr<const Domain<D>>& domain) {
            return SharedMarch{long_call([&] {
                MarchState<D> state = march_from<D>(Domain<D>{*domain}, the_case.start);
                SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
                return std::make_shared<March<D>>(std::move(state), std::move(settings));
            })};
        },
        domain_of(the_case).domain);
}

/// The dimension of the cells in a mesh file.
int dimension_in(const std::filesystem::path& path, const io::ReadOptions& reading) {
    return long_call([&] { return io::read_mesh(path, reading).top_dimension(); });
}

StartDomain domain_of_file(const std::filesystem::path& path, const std::vector<std::string>& regions,
                           bool linear, const std::string& patch_array, std::optional<int> dimension) {
    Case only_mesh;
    const io::ReadOptions reading{linear, patch_array};
    only_mesh.initial = InitialMesh{path, regions, reading};
    only_mesh.dimension = dimension ? *dimension : dimension_in(path, reading);
    return domain_of(only_mesh);
}

/// Runs a case; `told` hears how far it has come.
py::dict run(Case the_case, const std::optional<std::filesystem::path>& out, bool resume,
             const py::object& told) {
    if (out) {
        the_case.directory = *out;
    }
    Remarks remarks;
    Listener listener = remarks.listener();
    Watch watch{told};
    listener.progress = [&watch](const RunProgress& run) { watch.tell(run); };
    const RunResult result = long_call(
        watch, [&watch](const WorkState&) { return watch.goes_on(); },
        [&] { return run_case(the_case, listener, {resume}); });
    remarks.warn();
    py::dict summary;
    summary["files"] = result.files;
    summary["cells"] = result.cells;
    summary["points"] = result.points;
    summary["slabs"] = result.slabs;
    return summary;
}

/// From a path, or a dict of tables as in a case file, whose paths are relative to `directory`.
Case case_from(const py::object& source, const std::filesystem::path& directory) {
    if (py::isinstance<py::dict>(source)) {
        const py::object text = py::module_::import("slabhull.toml").attr("as_toml")(source);
        return parse_case(text.cast<std::string>(), directory / "case");
    }
    try {
        return read_case(source.cast<std::filesystem::path>());
    } catch (const py::cast_error&) {
        throw UsageError{"a case is the path of a case file, or a dict with its tables"};
    }
}

void bind_case_class(py::module_& module) {
    py::class_<Case>(module, "Case", "A case as a case file says it.")
        .def(py::init(&case_from), py::arg("source"), py::arg("directory") = ".",
             "From a case file, or from a dict with the tables of one, whose paths are relative to "
             "`directory`.")
        .def_static("experiment", &experiment_case, py::arg("name"), py::arg("level") = 1,
                    "One of the paper's experiments.")
        .def_readonly("title", &Case::title, "The title, \"\" for none.")
        .def_readonly("dimension", &Case::dimension, "D, that of space.")
        .def_readonly("start", &Case::start, "The time at which the first slab begins.")
        .def_readonly("end", &Case::end, "The time at which the last slab ends.")
        .def_readonly("slabs", &Case::slabs, "The number of slabs.")
        .def_property(
            "directory", [](const Case& self) { return self.directory; },
            [](Case& self, const std::filesystem::path& directory) { self.directory = directory; },
            "Where run() writes.")
        .def("level_times", py::overload_cast<int>(&Case::level_times, py::const_), py::arg("slab"),
             "The times of the levels of a slab; only its two ends where layers follow from the motion.")
        .def("domain", domain_of, "The domain that the case starts with.")
        .def("march", march_of, "A march with the case's domain, motions and settings.")
        .def("run", run, py::arg("out") = py::none(), py::arg("resume") = false,
             py::arg("on_progress") = py::none(),
             "Builds, checks and writes all slabs as `slabhull build` does. Returns files, cells, points and "
             "slabs.");
}

} // namespace

void bind_case(py::module_& module) {
    bind_case_class(module);
    module.attr("Domain").attr("from_file") =
        py::module_::import("builtins")
            .attr("staticmethod")(py::cpp_function(
                domain_of_file, py::name("from_file"), py::arg("path"),
                py::arg("regions") = std::vector<std::string>{}, py::arg("linear") = false,
                py::arg("patch_array") = "", py::arg("dimension") = py::none(),
                "From a mesh file of any format; see [initial] in docs/case-file.md. Without "
                "`dimension` the file is read twice."));
    module.def(
        "experiment_names",
        [] {
            const auto names = experiment_names();
            return std::vector<std::string>(names.begin(), names.end());
        },
        "The names of the paper's six experiments.");
}

} // namespace slabhull::python
