// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <fstream>
#include <malloc.h>
#include <string>

namespace slabhull::bench {

/// The number after `name` in a file of /proc/self, in bytes.
inline std::size_t process_bytes(const char* file, const std::string& name) {
    std::ifstream in{std::string{"/proc/self/"} + file};
    for (std::string word; in >> word;) {
        if (std::size_t kib = 0; word == name && in >> kib) {
            return kib * 1024;
        }
    }
    return 0;
}

/// The most memory that is resident at once between construction and more(), beyond what was at first.
class PeakMemory {
public:
    PeakMemory() {
        ::malloc_trim(0);                            // or what others have freed would serve us, uncounted
        std::ofstream{"/proc/self/clear_refs"} << 5; // the peak starts again from here
        before_ = process_bytes("status", "VmRSS:");
    }
    double more() const { return static_cast<double>(process_bytes("status", "VmHWM:") - before_); }

private:
    std::size_t before_;
};

/// The part of this process's memory (files' aside) that is in huge pages now.
inline double huge_page_share() {
    return static_cast<double>(process_bytes("smaps_rollup", "AnonHugePages:")) /
           static_cast<double>(process_bytes("smaps_rollup", "Anonymous:"));
}

} // namespace slabhull::bench
