// SPDX-License-Identifier: BSD-3-Clause
// What both ways to a child share.
#pragma once

#include "slabhull/core/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/types.h>
#include <unistd.h>

namespace slabhull::detail {

/// A file descriptor that is closed with its owner.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_{number} {}
    Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        close_now();
        number_ = std::exchange(other.number_, -1);
        return *this;
    }
    ~Descriptor() { close_now(); }

    int number() const { return number_; }
    void close_now() {
        if (number_ >= 0) {
            ::close(std::exchange(number_, -1));
        }
    }

private:
    int number_;
};

/// Reads or writes until all bytes went through; false when the other side is gone.
template<class Call, class Byte>
bool transfer(Call call, int descriptor, Byte* place, std::size_t size) {
    while (size > 0) {
        const ssize_t done = call(descriptor, place, std::min<std::size_t>(size, std::size_t{1} << 30));
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return false;
        }
        place += done;
        size -= static_cast<std::size_t>(done);
    }
    return true;
}

constexpr int job_threw = 3; ///< exit code

/// In a child: the host's handlers do not run in it, and what the host ignores stays ignored.
void reset_signals();
/// In a child: it ends with its parent.
void die_with(pid_t parent);
/// Runs the job of a child, which sends to `out`; ends the process.
[[noreturn]] void run_job(int out, const std::function<void(const Send&)>& job);
/// A terminal sends Ctrl-C to parent and child alike. Throws Interrupted where the parent is to stop, too.
void hear_of_signal();

} // namespace slabhull::detail
