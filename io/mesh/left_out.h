// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace slabhull::io {

/// Throws FormatLeftOut for the format `title`, which SLABHULL_FORMATS calls `name`.
[[noreturn]] void refuse_left_out(std::string_view title, std::string_view name);

} // namespace slabhull::io
