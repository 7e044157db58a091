// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

namespace slabhull {

/// Bytes that this process and its children can still take without swapping: what the machine has free, or
/// what the control groups that it runs in leave (either version), if that is less. A quarter of an exbibyte
/// when neither is told. `root` is where proc and sys are.
std::size_t available_memory(const std::filesystem::path& root = "/");

/// Gives memory that was freed, but kept for later, back to the machine; to be called before much is taken
/// for long. A few milliseconds. Does nothing where the C library cannot.
void give_back_freed_memory();

} // namespace slabhull
