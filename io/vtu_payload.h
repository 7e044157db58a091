// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compression.h"
#include "slabhull/core/array.h"

#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace slabhull::io {

/// How a VTU file stores the bytes of an array.
struct PayloadFormat {
    bool swapped = false;       ///< the byte order is not ours
    std::size_t word_bytes = 4; ///< of the numbers in front of the bytes: 4 or 8
    Compressor compressor = Compressor::none;
};

/// The bytes of an array, those of its values.
struct Payload {
    std::string_view bytes;
    Array<char> own;            ///< holds the bytes where they do not stand in the file as they are
    std::uint64_t consumed = 0; ///< bytes of the file that they were made from
};

/// Why an array's bytes cannot be had.
struct PayloadError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The array whose numbers and bytes stand at the beginning of `data`, raw or in base64. Unpacks no more
/// than `most` bytes, nor more than the compressor could have packed into `data`, and allocates only then.
/// Throws PayloadError.
Payload read_payload(const PayloadFormat& format, std::string_view data, bool is_base64, std::uint64_t most);

} // namespace slabhull::io
