// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/csv_table.h"

#include <string>
#include <string_view>

// Functions shared by readers of tables.
namespace slabhull::io {

/// Throws InputError: file, line, text.
[[noreturn]] void fail_in_line(const std::string& path, std::size_t line, const std::string& text);

/// Whether all of `text` is a number, which `value` receives; it may be infinite or NaN.
bool parse_number(std::string_view text, double& value);

/// The beginning of `text` in double quotes, safe for a terminal.
std::string in_quotes(std::string_view text);

/// Whether a text, after comments, begins like OpenFOAM's list of rows (time ((x y z) (roll pitch yaw))):
/// with a parenthesis, or a count and a parenthesis.
bool is_six_dof_list(std::string_view text);

/// Reads such a list, with the columns time, x, y, z, roll_deg, pitch_deg, yaw_deg.
CsvTable read_six_dof_list(std::string_view text, const std::string& path);

} // namespace slabhull::io
