// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace slabhull {

/// Text from a file, fit for a message: no control characters, and long texts lose their middle.
std::string readable(std::string_view text);

/// Of the names `known`, the one that `name` may be misspelt for: it differs in a few letters. Empty if there
/// is none.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

/// `; did you mean "right"?` where a known name is near, else nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

} // namespace slabhull
