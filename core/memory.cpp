// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/memory.h"

#include "core/page_pool.h"

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <cstdlib> // defines __GLIBC__
#include <fstream>
#include <optional>
#include <string>

#include <pthread.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace slabhull {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t untold = std::size_t{1} << 58;

std::size_t free_on_machine(const fs::path& root) {
    std::ifstream in{root / "proc/meminfo"};
    for (std::string word; in >> word;) {
        if (std::size_t kib = 0; word == "MemAvailable:" && in >> kib) {
            return kib * 1024;
        }
    }
    return untold;
}

std::optional<std::size_t> number_in(const fs::path& file) {
    std::ifstream in{file};
    std::size_t number = 0;
    return in >> number ? std::optional{number} : std::nullopt; // "max" where there is no limit
}

/// Page cache that the kernel would give up, although the group counts it as used.
std::size_t reclaimable(const fs::path& group, const std::string& name) {
    std::ifstream in{group / "memory.stat"};
    for (std::string word; in >> word;) {
        if (std::size_t bytes = 0; word == name && in >> bytes) {
            return bytes;
        }
    }
    return 0;
}

/// File names in a control group; they differ between versions 1 and 2.
struct GroupFiles {
    const char* limit;
    const char* used;
    const char* reclaimable;
};

/// The least that is left in a group and its ancestors.
std::size_t free_in_groups(const fs::path& top, fs::path group, const GroupFiles& files) {
    std::size_t free = untold;
    for (;; group = group.parent_path()) {
        const fs::path folder = top / group.relative_path();
        const auto limit = number_in(folder / files.limit);
        const auto used = number_in(folder / files.used);
        if (limit && used) {
            const std::size_t kept = *used - std::min(*used, reclaimable(folder, files.reclaimable));
            free = std::min(free, *limit - std::min(*limit, kept));
        }
        if (!group.has_relative_path()) {
            return free;
        }
    }
}

/// Lines of /proc/self/cgroup are number:controllers:group; the second version has the number 0 and no
/// controllers.
std::size_t free_in_own_groups(const fs::path& root) {
    const fs::path top = root / "sys/fs/cgroup";
    std::ifstream in{root / "proc/self/cgroup"};
    std::size_t free = untold;
    for (std::string line; std::getline(in, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
        if (second == std::string::npos) {
            continue;
        }
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path group = line.substr(second + 1);
        if (controllers.empty()) {
            free =
                std::min(free, free_in_groups(top, group, {"memory.max", "memory.current", "inactive_file"}));
        } else if (controllers == "memory") {
            free = std::min(free, free_in_groups(top / "memory", group,
                                                 {"memory.limit_in_bytes", "memory.usage_in_bytes",
                                                  "total_inactive_file"}));
        }
    }
    return free;
}

} // namespace

std::size_t available_memory(const fs::path& root) {
    return std::min(free_on_machine(root), free_in_own_groups(root));
}

void give_back_freed_memory() {
#ifdef __GLIBC__
    constexpr std::size_t worth_the_faults = std::size_t{16} << 20; // what is taken again is slow to touch
    if (::mallinfo2().fordblks > worth_the_faults) {
        ::malloc_trim(0);
    }
#endif
}

void keep_freed_memory() {
    [[maybe_unused]] static const int registered =
        pthread_atfork([] { detail::page_pool().lock(); }, [] { detail::page_pool().unlock(); },
                       [] { detail::page_pool().unlock(); });
    detail::page_pool().begin_to_keep();
#ifdef __GLIBC__
    constexpr int mib = 1 << 20;
    ::mallopt(M_MMAP_THRESHOLD, 8 * mib); // larger ones go back at once
    ::mallopt(M_TRIM_THRESHOLD, 24 * mib);
    // Threads come and go: what one of them has freed serves the next.
    ::mallopt(M_ARENA_MAX, std::max(2, thread_count()));
#endif
}

} // namespace slabhull
