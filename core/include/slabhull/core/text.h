// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull {

/// Text from a file as messages can show it: without control characters, and long ones without their middle.
std::string readable(std::string_view text);

} // namespace slabhull
