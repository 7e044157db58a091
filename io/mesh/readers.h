// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/read_options.h"
#include "slabhull/io/soup.h"

#include <filesystem>

namespace slabhull::io {

// Readers that have options; files.h has them without.

Soup read_msh(const std::filesystem::path& path, const ReadOptions& options);
Soup read_vtu(const std::filesystem::path& path, const ReadOptions& options);
Soup read_vtk(const std::filesystem::path& path, const ReadOptions& options);
Soup read_pvtu(const std::filesystem::path& path, const ReadOptions& options);
Soup read_xdmf(const std::filesystem::path& path, const ReadOptions& options);
Soup read_tetgen(const std::filesystem::path& path, const ReadOptions& options);
Soup read_medit(const std::filesystem::path& path, const ReadOptions& options);

} // namespace slabhull::io
