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

/// Bytes on their way to a file, through three large blocks: while one is filled, a thread writes those
/// before it. They go past the system's page cache, which where we measured took a gigabyte per second and
/// the disk three; where the file system does not let them, and a short file's, go through it.
/// Errors are kept as error() until somebody asks.
class BlockWriter {
public:
    /// The descriptor stays the caller's.
    explicit BlockWriter(int descriptor) : descriptor_{descriptor} {}
    ~BlockWriter() { stop(); }
    BlockWriter(const BlockWriter&) = delete;
    BlockWriter& operator=(const BlockWriter&) = delete;

    /// What is free of the block that is being filled, at least a byte.
    std::span<char> room();
    /// The first `size` bytes of room() are filled.
    void advance(std::size_t size);
    /// Gives all bytes to the system. Nothing may follow.
    void finish();
    /// The first error's errno, 0 for none. All that follows it is lost.
    int error();

private:
    static constexpr std::size_t block_bytes = std::size_t{8} << 20;
    static constexpr std::size_t blocks = 3;

    struct Block {
        Array<char> bytes; ///< aligned as direct writing wants it
        std::size_t size = 0;
        bool full = false; ///< and the thread's
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
