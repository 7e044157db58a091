// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/utf8.h"

#include <cstddef>

namespace slabhull::io {

namespace {

constexpr unsigned char first_beyond_ascii = 0x80;

bool goes_on(unsigned char c) {
    return (c & 0xC0) == 0x80;
}

/// Number of bytes of the character at `at`; 0 if it is invalid or longer than needed.
std::size_t character_size(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) {
        return at + i < text.size() ? static_cast<unsigned char>(text[at + i])
                                    : static_cast<unsigned char>(0);
    };
    const unsigned char lead = byte(0);
    if (lead < first_beyond_ascii) {
        return 1;
    }
    if (lead >= 0xC2 && lead <= 0xDF) {
        return goes_on(byte(1)) ? 2 : 0;
    }
    if (lead >= 0xE0 && lead <= 0xEF) {
        const bool allowed = !(lead == 0xE0 && byte(1) < 0xA0) && !(lead == 0xED && byte(1) > 0x9F);
        return allowed && goes_on(byte(1)) && goes_on(byte(2)) ? 3 : 0;
    }
    if (lead >= 0xF0 && lead <= 0xF4) {
        const bool allowed = !(lead == 0xF0 && byte(1) < 0x90) && !(lead == 0xF4 && byte(1) > 0x8F);
        return allowed && goes_on(byte(1)) && goes_on(byte(2)) && goes_on(byte(3)) ? 4 : 0;
    }
    return 0;
}

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t size = character_size(text, at);
        if (size == 0) {
            return false;
        }
        at += size;
    }
    return true;
}

} // namespace

std::string as_utf8(std::string_view text) {
    if (is_utf8(text)) {
        return std::string{text};
    }
    std::string result;
    for (const char each : text) {
        const auto c = static_cast<unsigned char>(each);
        if (c < first_beyond_ascii) {
            result += each;
        } else {
            result += static_cast<char>(0xC0 | c >> 6);
            result += static_cast<char>(0x80 | (c & 0x3F));
        }
    }
    return result;
}

} // namespace slabhull::io
