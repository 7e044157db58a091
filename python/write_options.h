// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/formats.h"

#include <pybind11/pybind11.h>

#include <filesystem>

namespace slabhull::python {

struct NamedFormat {
    const io::Format* format;
    io::WriteOptions options;
};

/// The format that `named` or the path's extension names, and the options in `named`: format, encoding,
/// version, four_dimensional, pieces. Throws UsageError for others and for a format that there is not.
NamedFormat format_from(const std::filesystem::path& path, const pybind11::kwargs& named);

} // namespace slabhull::python
