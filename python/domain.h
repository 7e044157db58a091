// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python/any.h"
#include "python/arrays.h"

#include "slabhull/slab/domain.h"

#include <pybind11/pybind11.h>

#include <memory>

namespace slabhull::python {

/// A mesh of the domain at an instant.
struct Cap {
    Any<SpatialMesh> mesh;
};

/// A checked domain that marches start from.
struct StartDomain {
    Any<Domain> domain;

    Cap mesh() const;
};

void bind_domain(py::module_& module);

} // namespace slabhull::python
