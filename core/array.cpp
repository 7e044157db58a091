// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/array.h"

#include "core/page_pool.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <new>
#include <sys/mman.h>

namespace slabhull::detail {

namespace {
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t worth_huge_pages = 2 * huge_page;

/// Up to whole huge pages.
constexpr std::size_t rounded(std::size_t bytes) {
    return (bytes + huge_page - 1) / huge_page * huge_page;
}

/// The addresses that a block of so many bytes gets: whole huge pages, and a multiple of a 16th of its size
/// or more, so that blocks of nearly the same size can take each other's place. Pages not used cost nothing.
constexpr std::size_t block_size(std::size_t bytes) {
    const std::size_t step = std::max(huge_page, std::bit_floor(bytes) / 16);
    return (bytes + step - 1) / step * step;
}
} // namespace

void* allocate_pages(std::size_t bytes) {
    if (bytes < worth_huge_pages) {
        return ::operator new(bytes);
    }
    // straight from the system, so that it goes back there: malloc keeps blocks of up to 32 MiB for itself
    const std::size_t wanted = block_size(bytes);
    if (void* const kept = page_pool().take(wanted)) {
        return kept;
    }
    void* const mapped =
        ::mmap(nullptr, wanted + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) {
        throw std::bad_alloc{};
    }
    char* const begin = static_cast<char*>(mapped);
    const std::size_t before =
        rounded(reinterpret_cast<std::uintptr_t>(begin)) - reinterpret_cast<std::uintptr_t>(begin);
    if (before > 0) {
        ::munmap(begin, before);
    }
    ::munmap(begin + before + wanted, huge_page - before);
    ::madvise(begin + before, wanted, MADV_HUGEPAGE); // advice: where it is refused, small pages serve
    return begin + before;
}

void release_pages(void* memory, std::size_t bytes) noexcept {
    if (bytes < worth_huge_pages) {
        ::operator delete(memory);
    } else {
        page_pool().put(memory, block_size(bytes));
    }
}

void empty_pages(void* memory, std::size_t kept, std::size_t bytes) noexcept {
    if (bytes >= worth_huge_pages && rounded(kept) < bytes) {
        ::madvise(static_cast<char*>(memory) + rounded(kept), rounded(bytes) - rounded(kept), MADV_DONTNEED);
    }
}

} // namespace slabhull::detail
