// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace slabhull {

/// Where the library's remarks go: warnings that a user should read, and the progress of long work.
/// The library itself prints nothing.
struct Listener {
    std::function<void(const std::string& text)> warning = [](const std::string&) {};
    /// `done` in [0, 1]
    std::function<void(const std::string& stage, double done)> progress = [](const std::string&, double) {};
};

} // namespace slabhull
