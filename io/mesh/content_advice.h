// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace slabhull::io {

/// What to do about a file that could not be read as `format`: it is empty, or looks like one of another
/// format. Begins with "; "; nothing where neither is so.
std::string content_advice(const std::filesystem::path& path, std::string_view format);

} // namespace slabhull::io
