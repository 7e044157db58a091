// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/compression.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <lz4.h>
#include <new>
#include <zlib.h>

namespace slabhull::io {

namespace {

bool unpack_zlib(std::string_view packed, char* out, std::size_t size) {
    char none = 0; // zlib needs a pointer even for 0 bytes
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

std::string pack_zlib(std::string_view bytes) {
    constexpr int level = 5; // VTK's default
    uLongf size = ::compressBound(bytes.size());
    std::string packed(size, '\0');
    const int result = ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                                   reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), level);
    if (result != Z_OK) { // the output is large enough, so memory is short
        throw std::bad_alloc{};
    }
    packed.resize(size);
    return packed;
}

std::string pack_lz4(std::string_view bytes) {
    const int room = ::LZ4_compressBound(static_cast<int>(bytes.size()));
    std::string packed(static_cast<std::size_t>(room), '\0');
    const int size =
        ::LZ4_compress_default(bytes.data(), packed.data(), static_cast<int>(bytes.size()), room);
    packed.resize(static_cast<std::size_t>(size));
    return packed;
}

} // namespace

std::uint64_t most_unpacked(Compressor compressor, std::uint64_t packed) {
    // deflate takes at least 2 bits for 258 bytes, LZ4 at least a byte for 255
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

std::string pack(Compressor compressor, std::string_view bytes) {
    return compressor == Compressor::zlib  ? pack_zlib(bytes)
           : compressor == Compressor::lz4 ? pack_lz4(bytes)
                                           : std::string{bytes};
}

} // namespace slabhull::io
