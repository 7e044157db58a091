// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull::io {

/// The text escaped for the value of an XML attribute.
std::string escaped(std::string_view text);

} // namespace slabhull::io
