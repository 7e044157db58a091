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
    bool swapped = false;       ///< the byte order is not ours
    std::size_t word_bytes = 4; ///< of the numbers in front of the bytes: 4 or 8
    Compressor compressor = Compressor::none;
};

/// Why an array's bytes cannot be had.
struct PayloadError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Who gets an array's bytes.
struct PayloadTaker {
    /// Once, before all others: how many bytes there will be.
    std::function<void(std::uint64_t bytes)> start;
    /// The next ones; a multiple of 8 but for the last ones.
    std::function<void(std::string_view bytes)> take;
};

/// Gives the array whose numbers and bytes stand at the beginning of `range`, raw or in base64, in portions
/// of a megabyte or of a packed block. Unpacks no more than `most` bytes, nor more than the compressor could
/// have packed into the range, and starts only then. Returns how many bytes of the file it took. Throws
/// PayloadError.
std::uint64_t read_payload(const PayloadFormat& format, FileBytes& file, FileRange range, bool is_base64,
                           std::uint64_t most, const PayloadTaker& taker);

/// Where the array's bytes stand in the file when they stand there as they are, neither packed nor in base64.
/// Throws PayloadError.
std::optional<FileRange> plain_payload(const PayloadFormat& format, const FileBytes& file, FileRange range,
                                       bool is_base64);

} // namespace slabhull::io
