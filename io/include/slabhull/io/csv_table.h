// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// Columns of numbers with names, from a text file.
struct CsvTable {
    std::string path;
    std::vector<std::string> columns; ///< names, no two the same
    Array<double> values;             ///< row by row, all finite
    Array<std::size_t> lines;         ///< the line of the file that each row stands on, from 1

    std::size_t rows() const { return lines.size(); }
    double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
    /// The place of the column with that name.
    std::optional<std::size_t> find(std::string_view name) const;

    /// Throws InputError: file, line of the row, text.
    [[noreturn]] void fail(std::size_t row, const std::string& text) const;
    /// Throws InputError: file, text and the columns that there are.
    [[noreturn]] void fail_columns(const std::string& text) const;
};

} // namespace slabhull::io
