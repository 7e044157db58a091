// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>

namespace slabhull::bench {

/// The part of this process's memory (files' aside) that is in huge pages now (Linux).
inline double huge_page_share() {
    const auto kibibytes = [](const char* name) {
        std::ifstream file{"/proc/self/smaps_rollup"};
        for (std::string word; file >> word;) {
            if (double size = 0; word == name && file >> size) {
                return size;
            }
        }
        return 0.0;
    };
    return kibibytes("AnonHugePages:") / kibibytes("Anonymous:");
}

} // namespace slabhull::bench
