// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <thread>

namespace slabhull::io {

/// Writes bytes to a file through three large blocks: while one is filled, a thread writes those before it.
/// Writing bypasses the page cache, which we measured at one gigabyte per second where the disk took three.
/// Short files, and file systems without direct writing, use the cache.
/// Errors are kept for error().
class BlockWriter {
public:
    /// The caller still owns the descriptor.
    explicit BlockWriter(int descriptor) : descriptor_{descriptor} {}
    ~BlockWriter() { stop(); }
    BlockWriter(const BlockWriter&) = delete;
    BlockWriter& operator=(const BlockWriter&) = delete;

    /// The free part of the current block, at least a byte.
    std::span<char> room();
    /// Marks the first `size` bytes of room() as filled.
    void advance(std::size_t size);
    /// Writes all remaining bytes. Nothing may be written after it.
    void finish();
    /// The first error's errno, 0 for none. All bytes after the error are lost.
    int error();

private:
    static constexpr std::size_t block_bytes = std::size_t{8} << 20;
    static constexpr std::size_t blocks = 3;

    struct Block {
        Array<char> bytes; ///< aligned for direct writing
        std::size_t size = 0;
        bool full = false; ///< and owned by the thread
    };

    void hand_over();
    void work();
    void stop();
    int write_block(const Block& block);
    int write_bytes(const char* bytes, std::size_t size);
    void set_direct(bool direct);

    int descriptor_;
    bool direct_ = false;
    bool direct_refused_ = false;
    std::array<Block, blocks> ring_;
    std::size_t current_ = 0;
    std::mutex lock_; ///< for `full` of the blocks, error_, done_
    std::condition_variable changed_;
    int error_ = 0;
    bool done_ = false;
    std::thread thread_; ///< runs from the first full block on
};

} // namespace slabhull::io
