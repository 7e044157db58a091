// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace slabhull::io {

/// Starts a comment of ours that tells the attributes: words NAME:real:COMPONENTS or NAME:integer:COMPONENTS.
inline constexpr const char* attribute_mark = "# attributes:";

} // namespace slabhull::io
