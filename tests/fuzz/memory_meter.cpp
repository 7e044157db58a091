// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/memory_meter.h"

#include <algorithm>
#include <atomic>
#include <cstdint>

#if defined(__SANITIZE_ADDRESS__)
#define SLABHULL_METER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SLABHULL_METER 1
#endif
#endif

#ifdef SLABHULL_METER
// of sanitizer/allocator_interface.h, which Debian's gcc comes without
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
extern "C" std::size_t __sanitizer_get_allocated_size(const volatile void* memory);
#endif

namespace fuzz {

namespace {

std::atomic<std::int64_t> live{0};
std::atomic<std::int64_t> most{0};

#ifdef SLABHULL_METER
void on_malloc(const volatile void*, std::size_t size) {
    const std::int64_t now = live += static_cast<std::int64_t>(size);
    if (now > most) { // readers allocate on one thread
        most = now;
    }
}

void on_free(const volatile void* memory) {
    if (memory != nullptr) {
        live -= static_cast<std::int64_t>(::__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
    }
}

const bool installed = ::__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;
#else
const bool installed = false;
#endif

} // namespace

MemoryMeter::MemoryMeter() {
    live = 0;
    most = 0;
}

std::size_t MemoryMeter::peak() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(0, most));
}

bool MemoryMeter::works() {
    return installed;
}

} // namespace fuzz
