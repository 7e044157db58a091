// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/compression.h"
#include "io/files/file_bytes.h"
#include "io/vtk/vtu_skeleton.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace slabhull::io {

/// How a VTU file stores the bytes of an array.
struct PayloadFormat {
    bool swapped = false;       ///< the byte order is not the machine's
    std::size_t word_bytes = 4; ///< size of the numbers in front of the data: 4 or 8
    Compressor compressor = Compressor::none;
};

/// Why an array's bytes cannot be read.
struct PayloadError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The receiver of an array's bytes.
struct PayloadTaker {
    /// Called first, once, with the total number of bytes.
    std::function<void(std::uint64_t bytes)> start;
    /// Called with the next bytes; their number is a multiple of 8, except in the last call.
    std::function<void(std::string_view bytes)> take;
};

/// Reads the array at the beginning of `range`, raw or in base64, in portions of a megabyte or of a packed
/// block. Refuses, before start(), arrays that unpack to more than `most` bytes or to more than the
/// compressor could have packed into the range. Returns the number of bytes read from the file. Throws
/// PayloadError.
std::uint64_t read_payload(const PayloadFormat& format, FileBytes& file, FileRange range, bool is_base64,
                           std::uint64_t most, const PayloadTaker& taker);

/// The range of the array's bytes in the file if they are neither packed nor in base64; else empty. Throws
/// PayloadError.
std::optional<FileRange> plain_payload(const PayloadFormat& format, const FileBytes& file, FileRange range,
                                       bool is_base64);

} // namespace slabhull::io
