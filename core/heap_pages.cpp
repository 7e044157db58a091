// SPDX-License-Identifier: BSD-3-Clause
#include "core/heap_pages.h"

#include <cstdint>
#include <cstdlib> // defines __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace slabhull::detail {

void grow_heap_in_huge_pages([[maybe_unused]] std::size_t bytes) noexcept {
#ifdef __GLIBC__
    constexpr std::size_t huge_page = std::size_t{2} << 20;
    constexpr int mib = 1 << 20;
    constexpr int largest = 31 * mib; // 32 are refused; larger blocks have pages of their own
    ::mallopt(M_MMAP_THRESHOLD, largest);
    ::mallopt(M_TRIM_THRESHOLD, -1); // never
    ::mallopt(M_TOP_PAD, static_cast<int>(bytes));
    char* const before = static_cast<char*>(::sbrk(0));
    void* volatile grown = std::malloc(largest - mib); // volatile: else compilers leave both calls out
    ::mallopt(M_TOP_PAD, 16 * mib);
    char* const end = static_cast<char*>(::sbrk(0));
    if (end > before) {
        const std::uintptr_t offset = reinterpret_cast<std::uintptr_t>(before) % huge_page;
        char* const begin = before + (offset > 0 ? huge_page - offset : 0);
        if (begin < end) {
            ::madvise(begin, static_cast<std::size_t>(end - begin), MADV_HUGEPAGE);
        }
    }
    std::free(grown);
#endif
}

} // namespace slabhull::detail
