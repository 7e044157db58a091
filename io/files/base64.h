// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <optional>
#include <string_view>

namespace slabhull::io {

/// Decodes base64 text, appending to `bytes`, in groups of four characters until there are at least `size`
/// bytes or no group is left. Padding may occur between parts that were encoded separately. Returns the
/// number of characters decoded; empty if the text is not base64.
std::optional<std::size_t> decode_base64(std::string_view text, std::size_t size, Array<char>& bytes);

} // namespace slabhull::io
