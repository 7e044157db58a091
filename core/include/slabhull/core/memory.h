// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace slabhull {

/// Bytes that this process and its children can still take without swapping: what the machine has free, or
/// what the control group that it runs in leaves, if that is less. A quarter of an exbibyte when neither is
/// told.
std::size_t available_memory();

} // namespace slabhull
