// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/memory.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

namespace slabhull {

namespace {

constexpr std::size_t untold = std::size_t{1} << 58;

std::size_t free_on_machine() {
    std::ifstream in{"/proc/meminfo"};
    for (std::string word; in >> word;) {
        if (std::size_t kib = 0; word == "MemAvailable:" && in >> kib) {
            return kib * 1024;
        }
    }
    return untold;
}

std::optional<std::size_t> number_in(const char* file) {
    std::ifstream in{file};
    std::size_t number = 0;
    return in >> number ? std::optional{number} : std::nullopt; // "max" where there is no limit
}

std::size_t free_in_group() {
    const auto limit = number_in("/sys/fs/cgroup/memory.max");
    const auto used = number_in("/sys/fs/cgroup/memory.current");
    return limit && used ? *limit - std::min(*limit, *used) : untold;
}

} // namespace

std::size_t available_memory() {
    return std::min(free_on_machine(), free_in_group());
}

} // namespace slabhull
