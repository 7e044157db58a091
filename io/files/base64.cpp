// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/base64.h"

#include <array>
#include <cstdint>

namespace slabhull::io {

namespace {

constexpr std::uint8_t foreign = 255;

constexpr std::array<std::uint8_t, 256> make_digits() {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> digits{};
    digits.fill(foreign);
    for (std::size_t i = 0; i < alphabet.size(); ++i) {
        digits[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    }
    return digits;
}
constexpr auto digits = make_digits();

std::uint32_t digit(char c) {
    return digits[static_cast<unsigned char>(c)];
}

} // namespace

std::optional<std::size_t> decode_base64(std::string_view text, std::size_t size, Array<char>& bytes) {
    std::size_t taken = 0;
    for (; bytes.size() < size && taken + 4 <= text.size(); taken += 4) {
        const std::string_view quad = text.substr(taken, 4);
        const int padding = quad[3] != '=' ? 0 : quad[2] != '=' ? 1 : 2;
        std::uint32_t bits = 0;
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t value = k >= 4 - padding ? 0 : digit(quad[static_cast<std::size_t>(k)]);
            if (value == foreign) {
                return std::nullopt;
            }
            bits = bits << 6 | value;
        }
        for (int k = 0; k < 3 - padding; ++k) {
            bytes.push_back(static_cast<char>(bits >> (16 - 8 * k) & 0xFF));
        }
    }
    return taken;
}

} // namespace slabhull::io
