// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull {

/// Text from a file, fit for a message: no control characters, and long texts lose their middle.
std::string readable(std::string_view text);

} // namespace slabhull
