// SPDX-License-Identifier: BSD-3-Clause
#include "core/sanitizer_fork.h"

#ifdef SLABHULL_SANITIZER_FORK
#include <pthread.h>

// Not public, but in the static library, for which builds with the sanitizer are linked with -static-libasan.
// NOLINTBEGIN(bugprone-reserved-identifier)
namespace __lsan {
void LockThreadRegistry();
void UnlockThreadRegistry();
void LockAllocator();
void UnlockAllocator();
} // namespace __lsan
namespace __sanitizer {
void StackDepotLockAll();
void StackDepotUnlockAll();
} // namespace __sanitizer
// NOLINTEND(bugprone-reserved-identifier)

namespace slabhull {

namespace {

void lock_sanitizer() {
    __lsan::LockThreadRegistry();
    __lsan::LockAllocator();
    __sanitizer::StackDepotLockAll();
}

void unlock_sanitizer() {
    __sanitizer::StackDepotUnlockAll();
    __lsan::UnlockAllocator();
    __lsan::UnlockThreadRegistry();
}

} // namespace

void prepare_sanitizer_for_fork() {
    [[maybe_unused]] static const int registered =
        pthread_atfork(lock_sanitizer, unlock_sanitizer, unlock_sanitizer);
}

} // namespace slabhull
#endif
