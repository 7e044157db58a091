// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace slabhull {

/// How a child process ended.
struct ChildEnd {
    bool received = false; ///< the parent got all it asked for
    int signal = 0;        ///< that killed it, 0 for none
    int exit_code = 0;
};

/// Writes `size` bytes to the parent; ends the child when nobody listens.
using Send = std::function<void(const void* bytes, std::size_t size)>;
/// Reads exactly `size` bytes from the child; false when it ended before.
using Receive = std::function<bool(void* bytes, std::size_t size)>;

/// Runs `job` in a forked copy of this process, whose crash costs nothing: it may read all memory of the
/// caller, and what it writes to memory or prints is lost. It has one thread, so it must not start parallel
/// loops. `receive` runs here meanwhile and returns whether it got all. The bytes go through a pipe
/// straight to where the caller wants them, so that no copy is held in between.
/// The child dies with the calling thread, by Ctrl-C too.
/// Throws GeometryError when the system gives no pipe or process; what `receive` throws, when the child has
/// ended.
ChildEnd run_in_child(const std::function<void(const Send&)>& job,
                      const std::function<bool(const Receive&)>& receive);

} // namespace slabhull
