// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/read_options.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <string>
#include <vector>

namespace slabhull::io {

/// Like read_vtu(), but a file without points and cells is an empty soup, as parallel writers make such
/// files. Curved cells, if they are read and all of one kind, get no tags.
Soup read_vtu_piece(const std::filesystem::path& path, const ReadOptions& options);

/// The files that a .pvtu names, as it names them. Throws InputError.
std::vector<std::string> pvtu_sources(const std::filesystem::path& path);

} // namespace slabhull::io
