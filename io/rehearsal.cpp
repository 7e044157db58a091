// SPDX-License-Identifier: BSD-3-Clause
#include "rehearsal.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace slabhull::io {

namespace {

void set_limit(int resource, rlim_t limit) {
    const rlimit both{limit, limit};
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

/// Sanitizers want terabytes of addresses, so they know no limit.
void limit_memory([[maybe_unused]] std::uint64_t more) {
#ifndef __SANITIZE_ADDRESS__
    unsigned long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        const bool read = std::fscanf(file, "%lu", &pages) == 1;
        std::fclose(file);
        if (read) {
            set_limit(RLIMIT_AS, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + more);
        }
    }
#endif
}

/// What befalls the child is its parent's to tell.
void prepare_child(std::uint64_t bytes) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
        std::signal(signal, SIG_DFL);
    }
    constexpr std::uint64_t megabyte = std::uint64_t{1} << 20;
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, 20 + bytes / megabyte);
    limit_memory(bytes + 256 * megabyte);
}

[[noreturn]] void play_child(int pipe, std::uint64_t bytes, const std::function<void()>& work) {
    prepare_child(bytes);
    int code = 0;
    try {
        work();
    } catch (const std::exception& error) {
        code = 1;
        const std::string text = error.what();
        if (::write(pipe, text.data(), text.size()) < 0) {
            code = 2;
        }
    }
    ::_exit(code);
}

std::string read_all(int pipe) {
    std::string text;
    std::array<char, 1024> buffer;
    for (ssize_t got = 1; got != 0;) {
        got = ::read(pipe, buffer.data(), buffer.size());
        if (got < 0 && errno != EINTR) {
            break;
        }
        text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got)));
    }
    return text;
}

} // namespace

void rehearse(const std::string& name, std::uint64_t bytes, const std::function<void()>& work) {
    std::array<int, 2> pipe{-1, -1};
    if (::pipe(pipe.data()) != 0) {
        throw InputError(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
    }
    const pid_t child = ::fork();
    if (child == 0) {
        play_child(pipe[1], bytes, work);
    }
    const int problem = errno;
    ::close(pipe[1]);
    const std::string text = child < 0 ? "" : read_all(pipe[0]);
    ::close(pipe[0]);
    if (child < 0) {
        throw InputError(fmt::format("{}: cannot be read: {}", name, std::strerror(problem)));
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) {
        throw InputError(fmt::format("{}: it is damaged: the library that reads it ends with \"{}\"", name,
                                     ::strsignal(WTERMSIG(status))));
    }
    if (WEXITSTATUS(status) != 0) {
        throw InputError(text.empty() ? fmt::format("{}: it cannot be read", name) : text);
    }
}

} // namespace slabhull::io
