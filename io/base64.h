// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <optional>
#include <string_view>

namespace slabhull::io {

/// The first `size` bytes that base64 text stands for. Parts that were encoded one by one, each with its
/// padding, are read on through. Nothing if the text is too short or no base64.
std::optional<Array<char>> decode_base64(std::string_view text, std::size_t size);

} // namespace slabhull::io
