// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace slabhull::io {

/// A name as UTF-8: as it stands where it is that, else read as Latin-1, as older programs write it. Reports,
/// which are JSON, hold nothing else.
std::string as_utf8(std::string_view text);

} // namespace slabhull::io
