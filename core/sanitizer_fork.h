// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#if defined(__SANITIZE_ADDRESS__) && __GNUC__ < 14
#define SLABHULL_SANITIZER_FORK
#endif

namespace slabhull {

/// Call it before a fork. In a build with AddressSanitizer, it sees to it that the child can allocate: a fork
/// copies one thread, but the locks of all, and where another thread is inside the allocator just then, the
/// child would wait for it forever. glibc's allocator takes care of this; the sanitizer's does so since
/// GCC 14.
#ifdef SLABHULL_SANITIZER_FORK
void prepare_sanitizer_for_fork();
#else
inline void prepare_sanitizer_for_fork() {}
#endif

} // namespace slabhull
