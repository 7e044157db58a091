// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace slabhull::io {

/// Runs `work` in a child process first, as damaged files can crash a foreign library. The child has the same
/// memory at the same addresses, so work that succeeds there succeeds here. Throws InputError if the child
/// crashes, hangs (more than 20 s plus a second per megabyte of `bytes`), or takes more than `bytes` plus 256
/// MiB of additional memory; if it throws InputError itself, with that text. `name` is what is being read.
void rehearse(const std::string& name, std::uint64_t bytes, const std::function<void()>& work);

} // namespace slabhull::io
