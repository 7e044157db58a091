// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/xml_text.h"

#include "io/files/utf8.h"
#include "slabhull/core/error.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull::io {

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string xml_name(std::string_view name) {
    const std::string text = as_utf8(name);
    const auto foreign = [](unsigned char c) { return c < ' '; };
    if (std::any_of(text.begin(), text.end(), foreign) || text.find("\xEF\xBF\xBE") != std::string::npos ||
        text.find("\xEF\xBF\xBF") != std::string::npos) {
        throw FormatLimit{
            fmt::format("the array \"{}\" has a character in its name that XML does not have; rename it, "
                        "or write MSH or legacy VTK",
                        readable(text))};
    }
    return escaped(text);
}

} // namespace slabhull::io
