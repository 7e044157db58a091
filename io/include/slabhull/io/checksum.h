// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace slabhull::io {

/// CRC-32 (that of zlib) of bytes that come in pieces.
class Checksum {
public:
    void add(const void* bytes, std::size_t size);
    std::uint32_t value() const { return value_; }

private:
    std::uint32_t value_ = 0;
};

/// The checksum of a whole file. Throws InputError if it cannot be read.
std::uint32_t checksum_of(const std::filesystem::path& path);

} // namespace slabhull::io
