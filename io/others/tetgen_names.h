// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace slabhull::io {

/// Starts our comment that lists the attributes: words NAME:real:COMPONENTS or NAME:integer:COMPONENTS.
inline constexpr const char* attribute_mark = "# attributes:";

/// The attribute of tetrahedra with their group's number.
inline constexpr const char* group_attribute = "slabhull:group";

} // namespace slabhull::io
