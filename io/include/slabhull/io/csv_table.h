// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// Named columns of numbers from a text file.
struct CsvTable {
    std::string path;
    std::vector<std::string> columns; ///< distinct names
    Array<double> values;             ///< row by row, all finite
    Array<std::size_t> lines;         ///< line number of each row in the file, from 1

    std::size_t rows() const { return lines.size(); }
    double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
    /// The index of the column with a name.
    std::optional<std::size_t> find(std::string_view name) const;

    /// Throws InputError: file, line of the row, text.
    [[noreturn]] void fail(std::size_t row, const std::string& text) const;
    /// Throws InputError: file, text and the names of the columns.
    [[noreturn]] void fail_columns(const std::string& text) const;
};

} // namespace slabhull::io
