// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/stopwatch.h"

#include "core/child_server.h"

#include <algorithm>

#include <sys/resource.h>

namespace slabhull {

namespace {

rusage usage_of(int who) {
    rusage usage{};
    ::getrusage(who, &usage);
    return usage;
}

double cpu_seconds_of(int who) {
    const rusage usage = usage_of(who);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::size_t peak_of(int who) {
    return static_cast<std::size_t>(usage_of(who).ru_maxrss) * 1024; // Linux counts in KiB
}

} // namespace

double cpu_seconds() {
    return cpu_seconds_of(RUSAGE_SELF);
}

double cpu_seconds_of_children() {
    return cpu_seconds_of(RUSAGE_CHILDREN) + usage_of_fresh_children().cpu_seconds;
}

std::size_t peak_memory() {
    return peak_of(RUSAGE_SELF);
}

std::size_t peak_memory_of_children() {
    return std::max(peak_of(RUSAGE_CHILDREN), usage_of_fresh_children().peak_bytes);
}

} // namespace slabhull
