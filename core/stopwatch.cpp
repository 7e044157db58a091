// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/stopwatch.h"

#include <sys/resource.h>

namespace slabhull {

namespace {

std::size_t peak_of(int who) {
    rusage usage{};
    ::getrusage(who, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

} // namespace

std::size_t peak_memory() {
    return peak_of(RUSAGE_SELF);
}

std::size_t peak_memory_of_children() {
    return peak_of(RUSAGE_CHILDREN);
}

} // namespace slabhull
