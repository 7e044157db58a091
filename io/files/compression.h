// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace slabhull::io {

enum class Compressor { none, zlib, lz4 };

/// The most bytes that `packed` bytes can unpack to, by the design of the format. Larger claims are refused.
std::uint64_t most_unpacked(Compressor compressor, std::uint64_t packed);

/// Unpacks one block (a zlib stream or an LZ4 block) to `out`. Returns false, with unspecified `out`, unless
/// the block is complete and of exactly `size` bytes.
bool unpack(Compressor compressor, std::string_view packed, char* out, std::size_t size);

/// Packs one block of at most a gigabyte for unpack().
std::string pack(Compressor compressor, std::string_view bytes);

} // namespace slabhull::io
