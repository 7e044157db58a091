// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <string>

namespace slabhull::bench {

/// Resident memory that something takes at its peak beyond what was there before: the kernel's own high-water
/// mark, reset through /proc (Linux). Untouched and returned pages do not count.
class ExtraMemory {
public:
    ExtraMemory() {
        std::ofstream{"/proc/self/clear_refs"} << "5";
        before_ = status("VmRSS:");
    }
    /// Bytes.
    double peak() const { return std::max(0.0, status("VmHWM:") - before_); }

private:
    static double status(const std::string& key) {
        std::ifstream file{"/proc/self/status"};
        for (std::string word; file >> word;) {
            double kibibytes = 0;
            if (word == key && file >> kibibytes) {
                return 1024 * kibibytes;
            }
        }
        return 0;
    }

    double before_ = 0;
};

} // namespace slabhull::bench
