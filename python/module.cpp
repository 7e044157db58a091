// SPDX-License-Identifier: BSD-3-Clause
// The extension module behind the package `slabhull`.
#include "python/bindings.h"
#include "python/domain.h"
#include "python/errors.h"
#include "python/filling.h"
#include "python/hull.h"
#include "python/march.h"
#include "python/mesh.h"
#include "python/motions.h"

#include "slabhull/core/parallel.h"
#include "slabhull/core/version.h"

#include <pybind11/pybind11.h>

PYBIND11_MODULE(_slabhull, module) {
    namespace python = slabhull::python;
    module.doc() = "Space-time hulls of moving domains; use the package slabhull.";
    module.attr("__version__") = SLABHULL_VERSION;
    python::translate_errors();
    python::bind_progress(module);
    python::bind_hull(module);
    python::bind_domain(module);
    python::bind_motions(module);
    python::bind_march(module);
    python::bind_filling(module);
    python::bind_mesh(module);
    python::bind_sections(module);
    python::bind_check(module);
    python::bind_case(module);
    python::bind_hull_files(module);
    module.def("thread_count", slabhull::thread_count, "Threads that parallel loops use.");
    module.def("set_thread_count", slabhull::set_thread_count, pybind11::arg("count"),
               "Sets them for the whole process; 0 means the machine's cores.");
}
