// SPDX-License-Identifier: BSD-3-Clause
#include "compression.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <lz4.h>
#include <zlib.h>

namespace slabhull::io {

namespace {

bool unpack_zlib(std::string_view packed, char* out, std::size_t size) {
    char none = 0; // zlib wants a place even for nothing
    uLongf unpacked = size;
    uLong used = packed.size();
    const int result = ::uncompress2(reinterpret_cast<Bytef*>(size > 0 ? out : &none), &unpacked,
                                     reinterpret_cast<const Bytef*>(packed.data()), &used);
    return result == Z_OK && unpacked == size && used == packed.size();
}

bool unpack_lz4(std::string_view packed, char* out, std::size_t size) {
    if (std::max(packed.size(), size) > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        return false;
    }
    const int unpacked =
        ::LZ4_decompress_safe(packed.data(), out, static_cast<int>(packed.size()), static_cast<int>(size));
    return unpacked >= 0 && static_cast<std::size_t>(unpacked) == size;
}

} // namespace

std::uint64_t most_unpacked(Compressor compressor, std::uint64_t packed) {
    // deflate spends at least 2 bits on 258 bytes, LZ4 at least a byte on 255
    const std::uint64_t ratio = compressor == Compressor::none   ? 1
                                : compressor == Compressor::zlib ? 1032
                                                                 : 255;
    return packed > std::numeric_limits<std::uint64_t>::max() / ratio
               ? std::numeric_limits<std::uint64_t>::max()
               : packed * ratio;
}

bool unpack(Compressor compressor, std::string_view packed, char* out, std::size_t size) {
    switch (compressor) {
    case Compressor::zlib:
        return unpack_zlib(packed, out, size);
    case Compressor::lz4:
        return unpack_lz4(packed, out, size);
    case Compressor::none:
        break;
    }
    if (packed.size() == size && size > 0) {
        std::memcpy(out, packed.data(), size);
    }
    return packed.size() == size;
}

} // namespace slabhull::io
