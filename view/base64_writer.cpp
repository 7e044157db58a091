// SPDX-License-Identifier: BSD-3-Clause
#include "view/base64_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace slabhull {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Three bytes or, at the end, fewer as four characters.
std::array<char, 4> quad_of(std::span<const std::byte> bytes) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        bits = bits << 8 | (k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k]) : 0);
    }
    std::array<char, 4> quad{'=', '=', '=', '='};
    for (std::size_t k = 0; k <= bytes.size(); ++k) {
        quad[k] = alphabet[bits >> (18 - 6 * k) & 63];
    }
    return quad;
}

} // namespace

void write_base64(io::AtomicFile& file, std::span<const std::byte> bytes) {
    constexpr std::size_t block = 3 << 14;
    std::array<char, block / 3 * 4> text;
    while (!bytes.empty()) {
        const auto piece = bytes.first(std::min(bytes.size(), block));
        std::size_t size = 0;
        for (std::size_t at = 0; at < piece.size(); at += 3, size += 4) {
            const auto quad = quad_of(piece.subspan(at, std::min<std::size_t>(3, piece.size() - at)));
            std::copy(quad.begin(), quad.end(), text.begin() + static_cast<std::ptrdiff_t>(size));
        }
        file.write(text.data(), size);
        bytes = bytes.subspan(piece.size());
    }
}

} // namespace slabhull
