// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/formats.h"

#include <string>

namespace slabhull::tools {

/// The format that `name` says or, where it is empty, the extension of `file`. Throws UsageError, naming the
/// option that would help, when there is none or it is not read (or written), before the file is touched.
const io::Format& format_to_read(const std::string& file, const std::string& name);
const io::Format& format_to_write(const std::string& file, const std::string& name);
const io::Format& format_to_write_in_pieces(const std::string& file, const std::string& name);

/// A line for each format: name, extensions, read or written; for --help.
std::string formats_help();

/// "triangles", for counts of the simplices of that dimension.
const char* simplices_called(int dimension);

} // namespace slabhull::tools
