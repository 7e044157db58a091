// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull::io {

/// A name as one word of printable ASCII, encoded as in VTK: "x%20y" for "x y".
std::string percent_encoded(std::string_view text);
std::string percent_decoded(std::string_view text);

} // namespace slabhull::io
