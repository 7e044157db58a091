// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python/any.h"
#include "python/arrays.h"

#include "slabhull/topology/hull.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <map>
#include <string>

namespace slabhull::python {

/// A hull and the columns of it that were asked for and are not stored as such.
class SharedHull {
public:
    explicit SharedHull(Any<Hull> hull) : hull_{std::move(hull)} {}

    const Any<Hull>& any() const { return hull_; }
    int dimension() const { return dimension_of(hull_); }

    /// A column that is made when it is first asked for, then kept.
    py::array made_once(const std::string& name, const std::function<py::array()>& make);

private:
    Any<Hull> hull_;
    std::map<std::string, py::array> made_;
};

void bind_hull(py::module_& module);

} // namespace slabhull::python
