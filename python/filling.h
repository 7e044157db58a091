// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python/any.h"

#include "slabhull/topology/filling.h"

#include <pybind11/pybind11.h>

#include <memory>

namespace slabhull::python {

/// A slab filled with simplices.
struct SharedFilling {
    Any<Filling> filling;
};

void bind_filling(pybind11::module_& module);

} // namespace slabhull::python
