// SPDX-License-Identifier: BSD-3-Clause
// What functions of Python are told while C++ works.
#include "python/bindings.h"

#include "slabhull/core/message.h"

#include <pybind11/stl.h>

namespace slabhull::python {

namespace py = pybind11;

void bind_progress(py::module_& module) {
    py::class_<RunProgress>(module, "Progress",
                            "How far long work has come; estimates are None where unknown.")
        .def_property_readonly(
            "stage", [](const RunProgress& run) { return run.work.stage; },
            "What is being done, such as \"cap meshing\"; \"done\" at the end of a run.")
        .def_property_readonly(
            "stage_share", [](const RunProgress& run) { return run.work.share(); },
            "The part of the stage that is done, in [0, 1].")
        .def_readonly("slab", &RunProgress::slab, "The slab that a run is building, from 0.")
        .def_readonly("slabs", &RunProgress::slabs, "How many a run has, as planned; 0 for other work.")
        .def_readonly("share", &RunProgress::share, "The part of a run's time that has passed, in [0, 1].")
        .def_readonly("cells", &RunProgress::cells, "Cells that a run has made so far.")
        .def_property_readonly("cells_per_second", &RunProgress::cells_per_second)
        .def_readonly("seconds", &RunProgress::seconds, "Since the work began.")
        .def_readonly("seconds_left", &RunProgress::seconds_left, "Until the run ends.");
}

} // namespace slabhull::python
