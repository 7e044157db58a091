// SPDX-License-Identifier: BSD-3-Clause
#include "io/xdmf/rehearsal.h"

#include "slabhull/core/child_process.h"
#include "slabhull/core/error.h"

#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <sys/resource.h>
#include <system_error>
#include <unistd.h>

namespace slabhull::io {

namespace {

void set_limit(int resource, rlim_t limit) {
    const rlimit both{limit, limit};
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

/// Limits memory, except under sanitizers, which need terabytes of addresses.
void limit_memory([[maybe_unused]] std::uint64_t more) {
#ifndef __SANITIZE_ADDRESS__
    unsigned long pages = 0;
    // No C++ stream: the child of a process with threads could wait for the lock of the global locale.
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        const bool read = std::fscanf(file, "%lu", &pages) == 1;
        std::fclose(file);
        if (read) {
            set_limit(RLIMIT_AS, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + more);
        }
    }
#endif
}

void limit_child(std::uint64_t bytes) {
    constexpr std::uint64_t megabyte = std::uint64_t{1} << 20;
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, 20 + bytes / megabyte);
    limit_memory(bytes + 256 * megabyte);
}

} // namespace

void rehearse(const std::string& name, std::uint64_t bytes, const std::function<void()>& work) {
    ChildAnswer answer;
    try {
        answer = ask_child([&] {
            limit_child(bytes);
            work();
            return std::string{};
        });
    } catch (const std::system_error& error) {
        throw InputError(fmt::format("{}: cannot be read: {}", name, error.code().message()));
    }
    if (answer.end.signal != 0) {
        throw InputError(fmt::format("{}: it is damaged: the library that reads it ends with \"{}\"", name,
                                     ::strsignal(answer.end.signal)));
    }
    if (!answer.end.received || answer.end.exit_code != 0) {
        throw InputError(answer.text.empty() ? fmt::format("{}: it cannot be read", name) : answer.text);
    }
}

} // namespace slabhull::io
