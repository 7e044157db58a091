// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python/any.h"

#include "slabhull/slab/sweep.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace slabhull::python {

namespace py = pybind11;

/// A motion of the library, not yet of a patch.
struct FieldMotion {
    Any<Motion> motion;
};

/// A function positions(tracks, t) of Python.
struct TrackMotion {
    py::object positions;
};

/// A surface that vertices are projected onto.
struct Projection {
    Any<ProjectionSurface> surface;
};

/// How the patch `name` moves: by a FieldMotion, a TrackMotion, None for standing still, or a function
/// velocity(x, t), x an (n, D) array, which is called with all vertices at once. `surface` is a Projection or
/// None. Throws UsageError for anything else, or for another dimension.
template<int D>
MovingPatch<D> moving_patch(const py::object& motion, const py::object& surface, const std::string& name);

void bind_motions(py::module_& module);

} // namespace slabhull::python
