// SPDX-License-Identifier: BSD-3-Clause
#include "core/page_pool.h"

#include <algorithm>

#include <sys/mman.h>

namespace slabhull::detail {

void* PagePool::take(std::size_t bytes) noexcept {
    if (!keeps_) {
        return nullptr;
    }
    const std::lock_guard guard{lock_};
    for (std::size_t k = count_; k-- > 0;) { // the latest is the likeliest to be in a cache
        if (blocks_[k].bytes == bytes) {
            void* const memory = blocks_[k].memory;
            remove(k);
            return memory;
        }
    }
    unmap_oldest(bytes);
    return nullptr;
}

void PagePool::put(void* memory, std::size_t bytes) noexcept {
    if (!keeps_) {
        ::munmap(memory, bytes);
        return;
    }
    const std::lock_guard guard{lock_};
    if (count_ == most) {
        unmap_oldest(1);
    }
    blocks_[count_++] = {memory, bytes};
}

void PagePool::give_back() noexcept {
    const std::lock_guard guard{lock_};
    unmap_oldest(static_cast<std::size_t>(-1));
}

std::size_t PagePool::kept_bytes() const {
    const std::lock_guard guard{lock_};
    std::size_t sum = 0;
    for (std::size_t k = 0; k < count_; ++k) {
        sum += blocks_[k].bytes;
    }
    return sum;
}

void PagePool::remove(std::size_t place) noexcept {
    std::copy(blocks_.data() + place + 1, blocks_.data() + count_, blocks_.data() + place);
    --count_;
}

/// So many that together they have at least so many bytes, or all.
void PagePool::unmap_oldest(std::size_t bytes) noexcept {
    for (std::size_t sum = 0; sum < bytes && count_ > 0; sum += blocks_[0].bytes, remove(0)) {
        ::munmap(blocks_[0].memory, blocks_[0].bytes);
    }
}

/// Never destroyed: arrays may live as long as the process.
PagePool& page_pool() {
    static PagePool& pool = *new PagePool;
    return pool;
}

} // namespace slabhull::detail
