// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/array.h"

#include <cstdlib>
#include <sys/mman.h>

namespace slabhull::detail {

namespace {
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t worth_huge_pages = 2 * huge_page;
} // namespace

void* allocate_pages(std::size_t bytes) {
    if (bytes < worth_huge_pages) {
        return ::operator new(bytes);
    }
    const std::size_t rounded = (bytes + huge_page - 1) / huge_page * huge_page;
    void* memory = std::aligned_alloc(huge_page, rounded);
    if (memory == nullptr) {
        throw std::bad_alloc{};
    }
    ::madvise(memory, rounded, MADV_HUGEPAGE); // advice: where it is refused, small pages serve
    return memory;
}

void release_pages(void* memory, std::size_t bytes) noexcept {
    if (bytes < worth_huge_pages) {
        ::operator delete(memory);
    } else {
        std::free(memory);
    }
}

} // namespace slabhull::detail
