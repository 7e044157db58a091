// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// How a child process ended.
struct ChildEnd {
    bool received = false; ///< the parent got all it asked for
    int signal = 0;        ///< that killed it, 0 for none
    int exit_code = 0;
};

/// Writes `size` bytes to the parent; ends the child when the parent has stopped reading.
using Send = std::function<void(const void* bytes, std::size_t size)>;
/// Reads exactly `size` bytes from the child; false when it ended before.
using Receive = std::function<bool(void* bytes, std::size_t size)>;

/// Runs `job` in a forked copy of this process, whose crash costs nothing: it may read all memory of the
/// caller, and what it writes to memory is lost. It has one thread, and may start parallel loops only when
/// the caller's process had no other threads. The host's signal handlers do not run in it, and what the host
/// ignores stays ignored; streams are flushed neither before nor after. A job that throws ends it with exit
/// code 3. `receive` runs here meanwhile and returns whether it got all. The bytes go through a pipe straight
/// to where the caller wants them, so that no copy is held in between.
/// The child dies with the calling thread, by Ctrl-C too.
/// Throws Interrupted when the work is to stop (see ProgressScope): the child has then been ended.
/// Throws std::system_error when the system gives no pipe or process; what `receive` throws, when the child
/// has ended.
ChildEnd run_in_child(const std::function<void(const Send&)>& job,
                      const std::function<bool(const Receive&)>& receive);

/// What a fresh child is told, in parts.
using Request = std::vector<std::span<const std::byte>>;
/// What it does: it knows the request, joined, and what this process had when it was copied.
using FreshJob = void (*)(std::span<const std::byte> request, const Send& send);

/// As run_in_child(), but the child is no copy of this process as it is now: it descends from a copy that was
/// made once, by start_child_server() or the first call. So it takes no more memory than its job, and this
/// process's pages stay its own, where after a fork each that is written would be copied. The child is ended
/// when this process ends. Where that copy cannot be had, it is as run_in_child().
ChildEnd run_in_fresh_child(FreshJob job, const Request& request,
                            const std::function<bool(const Receive&)>& receive);

/// Makes the copy of this process from which fresh children descend; best while it is small and has one
/// thread. The copy waits, holds no files open, and ends with this process.
void start_child_server();

/// What came back from a child.
struct ChildAnswer {
    ChildEnd end;
    std::string text; ///< what the job returned, or why it failed; only if end.received
};

/// Runs a job in a child and returns its text. If the job throws, the text is that of the exception, and
/// the exit code that of the Error, or of Failure::geometry for other exceptions.
/// Throws as run_in_child() does when the system gives no pipe or process.
ChildAnswer ask_child(const std::function<std::string()>& job);

/// For jobs that foreign code may crash: from here on this process prints nothing, reads nothing from the
/// standard input and leaves no core.
void fall_silent();

} // namespace slabhull
