// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull::io {

/// The text escaped for the value of an XML attribute.
std::string escaped(std::string_view text);

/// The name of an array for an XML attribute, as UTF-8. Throws FormatLimit for characters that XML does not
/// have.
std::string xml_name(std::string_view name);

} // namespace slabhull::io
