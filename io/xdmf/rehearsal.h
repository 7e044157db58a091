// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace slabhull::io {

/// Does in a child process what a foreign library that damaged files can crash is about to do here. The child
/// has the same memory at the same addresses, so what it survives will be survived here. Throws InputError
/// when it crashes, loops (more than 20 s and a second for each megabyte of `bytes`), takes `bytes` and 256
/// MiB more memory than there is, or itself throws one, and then with its words. `name` is what is being
/// read.
void rehearse(const std::string& name, std::uint64_t bytes, const std::function<void()>& work);

} // namespace slabhull::io
