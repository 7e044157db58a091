// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/formats.h"

#include <string>

namespace slabhull::tools {

/// The format of that name or, where `name` is empty, that of the extension of `file`. Throws UsageError when
/// there is none, naming the option that would help, or when this build has it not; the file is not touched.
const io::Format& format_to_read(const std::string& file, const std::string& name);
const io::Format& format_to_write(const std::string& file, const std::string& name);

/// Reads the file in the format that `name` says or, where it is empty, as io::read_mesh() does; prints the
/// reader's remarks. Throws UsageError for a name that is none.
io::Soup read_named(const std::string& file, const std::string& name);

/// What the reader remarked, to stderr.
void print_remarks(const io::Soup& soup);

/// A line for each format, with its name and extensions; for --help.
std::string formats_help();

/// "triangles", for counts of the simplices of that dimension.
const char* simplices_called(int dimension);

} // namespace slabhull::tools
