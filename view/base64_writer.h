// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// Writes bytes as base64, padded, without line breaks.
void write_base64(io::AtomicFile& file, std::span<const std::byte> bytes);

} // namespace slabhull
