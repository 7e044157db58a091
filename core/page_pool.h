// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>

namespace slabhull::detail {

/// Large blocks of memory that were given back, kept for the next of the same size: to touch fresh memory
/// costs several times more than to write to it. For all threads.
///
/// The kept blocks and those in use, together, are never more than those in use were at the worst moment:
/// before more is taken from the system, as many kept bytes go back to it.
class PagePool {
public:
    explicit PagePool(bool keeps = false) : keeps_{keeps} {}
    ~PagePool() { give_back(); }
    PagePool(const PagePool&) = delete;
    PagePool& operator=(const PagePool&) = delete;

    /// From now on blocks are kept.
    void begin_to_keep() { keeps_ = true; }

    /// A kept block of exactly so many bytes. Null when there is none: then as many bytes have gone back to
    /// the system, if so many were kept, so that the caller may take them from there.
    void* take(std::size_t bytes) noexcept;

    /// Takes a block that was mapped; what it holds is lost.
    void put(void* memory, std::size_t bytes) noexcept;

    /// Gives all kept blocks back to the system.
    void give_back() noexcept;

    std::size_t kept_bytes() const;

    /// To be held by a thread that forks the process, so that the child finds the pool in order. No others.
    void lock() { lock_.lock(); }
    void unlock() { lock_.unlock(); }

private:
    struct Block {
        void* memory = nullptr;
        std::size_t bytes = 0;
    };

    void remove(std::size_t place) noexcept;
    void unmap_oldest(std::size_t bytes) noexcept;

    static constexpr std::size_t most = 64;

    mutable std::mutex lock_;
    std::array<Block, most> blocks_; ///< the first count_, the oldest first
    std::size_t count_ = 0;
    std::atomic<bool> keeps_;
};

/// That of Array. Keeps nothing before keep_freed_memory().
PagePool& page_pool();

} // namespace slabhull::detail
