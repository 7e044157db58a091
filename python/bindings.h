// SPDX-License-Identifier: BSD-3-Clause
// Parts of the module that no other part needs.
#pragma once

#include <pybind11/pybind11.h>

namespace slabhull::python {

void bind_case(pybind11::module_& module);
void bind_check(pybind11::module_& module);
void bind_progress(pybind11::module_& module);
/// Needs: bind_hull(), bind_filling() and bind_mesh().
void bind_hull_files(pybind11::module_& module);
void bind_sections(pybind11::module_& module);

} // namespace slabhull::python
