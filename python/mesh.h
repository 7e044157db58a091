// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <string>

namespace slabhull::python {

/// The content of a mesh file, of any format.
struct SharedMesh {
    std::shared_ptr<const io::Soup> soup;
};

/// Writes a soup in the format that `options` or the path's extension names. Options are format, encoding,
/// version, four_dimensional and pieces. What the format cannot hold becomes a warning of Python.
void write_soup(io::Soup soup, const std::filesystem::path& path, const pybind11::kwargs& options);

void bind_mesh(pybind11::module_& module);

} // namespace slabhull::python
