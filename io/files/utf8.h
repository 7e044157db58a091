// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull::io {

/// A name as UTF-8: unchanged if it is valid, else read as Latin-1, which older programs write. JSON reports
/// must be UTF-8.
std::string as_utf8(std::string_view text);

} // namespace slabhull::io
