// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/percent_text.h"

#include <charconv>
#include <fmt/format.h>

namespace slabhull::io {

std::string percent_encoded(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c > ' ' && c < '\x7f' && c != '"' && c != '%') {
            result += c;
        } else {
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return result;
}

std::string percent_decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned char code = 0;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(&text[i + 1], &text[i + 1] + 2, code, 16).ptr == &text[i + 1] + 2) {
            result += static_cast<char>(code);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

} // namespace slabhull::io
