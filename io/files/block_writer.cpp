// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/block_writer.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace slabhull::io {

std::span<char> BlockWriter::room() {
    Block& block = ring_[current_];
    if (block.bytes.empty()) {
        block.bytes.resize(block_bytes);
    }
    return std::span{block.bytes}.subspan(block.size);
}

void BlockWriter::advance(std::size_t size) {
    Block& block = ring_[current_];
    block.size += size;
    if (block.size == block_bytes) {
        hand_over();
    }
}

/// Passes the full block to the thread and waits until the next one is free.
void BlockWriter::hand_over() {
    if (!thread_.joinable()) {
        thread_ = std::thread{[this] { work(); }};
    }
    std::unique_lock guard{lock_};
    ring_[current_].full = true;
    changed_.notify_all();
    current_ = (current_ + 1) % blocks;
    changed_.wait(guard, [this] { return !ring_[current_].full; });
    ring_[current_].size = 0;
}

/// Writes block after block; after an error, discards them.
void BlockWriter::work() {
    for (std::size_t next = 0;; next = (next + 1) % blocks) {
        std::unique_lock guard{lock_};
        changed_.wait(guard, [&] { return ring_[next].full || done_; });
        if (!ring_[next].full) {
            return;
        }
        const bool lost = error_ != 0;
        guard.unlock();
        const int error = lost ? 0 : write_block(ring_[next]);
        guard.lock();
        error_ = lost ? error_ : error;
        ring_[next].full = false;
        changed_.notify_all();
    }
}

void BlockWriter::stop() {
    if (thread_.joinable()) {
        {
            const std::lock_guard guard{lock_};
            done_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
}

void BlockWriter::finish() {
    stop();
    if (error_ == 0) {
        error_ = write_block(ring_[current_]);
    }
    ring_[current_].size = 0;
}

int BlockWriter::error() {
    const std::lock_guard guard{lock_};
    return error_;
}

/// Writes whole pages directly, unless the block is all of a short file, and the rest through the page cache.
int BlockWriter::write_block(const Block& block) {
    constexpr std::size_t page = 4096;
    const bool direct = !direct_refused_ && (direct_ || block.size == block_bytes);
    const std::size_t whole = direct ? block.size / page * page : 0;
    if (whole > 0) {
        set_direct(true);
        const int error = write_bytes(block.bytes.data(), whole);
        if (error != 0) {
            return error;
        }
    }
    if (block.size > whole) {
        set_direct(false);
        return write_bytes(block.bytes.data() + whole, block.size - whole);
    }
    return 0;
}

/// Writes all bytes; returns the errno, 0 for none.
int BlockWriter::write_bytes(const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, bytes, size);
        if (written < 0 && errno == EINVAL && direct_) { // direct writing was accepted but fails
            set_direct(false);
            direct_refused_ = true;
        } else if (written < 0 && errno != EINTR) {
            return errno;
        }
        const auto step = static_cast<std::size_t>(std::max<ssize_t>(0, written));
        bytes += step;
        size -= step;
    }
    return 0;
}

void BlockWriter::set_direct(bool direct) {
    if (direct == direct_ || direct_refused_) {
        return;
    }
    const int flags = ::fcntl(descriptor_, F_GETFL);
    const bool done =
        flags >= 0 && ::fcntl(descriptor_, F_SETFL, direct ? flags | O_DIRECT : flags & ~O_DIRECT) == 0;
    direct_ = direct && done;
    direct_refused_ = direct && !done;
}

} // namespace slabhull::io
