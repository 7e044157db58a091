// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>

namespace slabhull {

/// Wall time since construction or the last lap.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    /// Seconds since the last lap, and starts the next.
    double lap() {
        const double passed = seconds();
        start_ = Clock::now();
        return passed;
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Processor time of this process's threads so far, in seconds, and of its ended children.
double cpu_seconds();
double cpu_seconds_of_children();

/// Largest resident memory of this process so far, in bytes, and of its ended children (the largest one).
std::size_t peak_memory();
std::size_t peak_memory_of_children();

} // namespace slabhull
