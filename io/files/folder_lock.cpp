// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/folder_lock.h"

#include "slabhull/core/error.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

namespace slabhull::io {

namespace {

/// Whether the lock is held by somebody else. What cannot be locked is not.
bool is_taken(int descriptor) {
    while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EINTR) {
            return errno == EWOULDBLOCK;
        }
    }
    return false;
}

} // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_{::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)} {
    // Meshers of a run that was killed have the lock until they are gone, too.
    constexpr int most_attempts = 20;
    constexpr std::chrono::milliseconds between{50};
    for (int attempt = 0; is_taken(descriptor_); ++attempt) {
        if (attempt == most_attempts) {
            ::close(descriptor_);
            throw UsageError(fmt::format("{}: another run is at work in this folder; wait until it ends, or "
                                         "give another folder with --out",
                                         folder.string()));
        }
        std::this_thread::sleep_for(between);
    }
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

} // namespace slabhull::io
