// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <optional>
#include <string_view>

namespace slabhull::io {

/// Appends the bytes that base64 text stands for, groups of four characters at a time, until there are at
/// least `size` or no four are left. Parts that were encoded one by one, each with its padding, are read on
/// through. Returns how many characters it took; nothing if they are no base64.
std::optional<std::size_t> decode_base64(std::string_view text, std::size_t size, Array<char>& bytes);

} // namespace slabhull::io
