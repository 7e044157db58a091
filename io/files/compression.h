// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace slabhull::io {

enum class Compressor { none, zlib, lz4 };

/// Most bytes that so many packed ones can stand for, by the design of their format: whoever claims more is
/// not trusted.
std::uint64_t most_unpacked(Compressor compressor, std::uint64_t packed);

/// Unpacks one block (a zlib stream or an LZ4 block) to `out`. False unless it is whole and of exactly
/// `size` bytes; `out` is then of no meaning.
bool unpack(Compressor compressor, std::string_view packed, char* out, std::size_t size);

/// Packs one block of at most a gigabyte, such that unpack() gives it back.
std::string pack(Compressor compressor, std::string_view bytes);

} // namespace slabhull::io
