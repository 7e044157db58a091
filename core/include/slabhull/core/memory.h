// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

namespace slabhull {

/// Bytes that this process and its children can still take without swapping: what the machine has free, or
/// what the control groups that it runs in leave (either version), if that is less. A quarter of an exbibyte
/// when neither is told. `root` is where proc and sys are.
std::size_t available_memory(const std::filesystem::path& root = "/");

/// Gives memory that was freed, but that the C library keeps for later, back to the machine, if it is much;
/// to be called before much is taken for long. A few milliseconds. Does nothing where the C library cannot.
void give_back_freed_memory();

/// From now on keeps more of the memory that this process frees, since fresh memory is slow to touch: for a
/// program that does the same again and again, as a march does slab after slab. Memory of arrays is kept
/// without limit, but it never makes the arrays' memory larger than it was in use at the worst moment; of
/// small blocks, the C library keeps some tens of MiB at most. Settings of the whole process: a library
/// leaves them to its user.
void keep_freed_memory();

} // namespace slabhull
