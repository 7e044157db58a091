// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"

#include <pybind11/pybind11.h>

#include <vector>

namespace slabhull::python {

/// Lets errors come out of the module as those of slabhull/errors.py.
void translate_errors();

/// The entities as its tuples (kind, number, where).
pybind11::list as_list(const std::vector<Entity>& entities);

} // namespace slabhull::python
