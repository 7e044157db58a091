// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/child_process.h"

#include "core/child_pipes.h"
#include "core/sanitizer_fork.h"

#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace slabhull {

namespace detail {

void hear_of_signal() {
    std::this_thread::sleep_for(
        std::chrono::milliseconds{100}); // for the parent's handler, and to be asked again
    go_on();
}

void reset_signals() {
    for (int number = 1; number < NSIG; ++number) {
        struct sigaction action {};
        if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) {
            std::signal(number, SIG_DFL); // fails for a few that nobody can set
        }
    }
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
}

void die_with(pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) { // it ended before the request was made
        _exit(job_threw);
    }
}

void run_job(int out, const std::function<void(const Send&)>& job) {
    try {
        job([out](const void* bytes, std::size_t size) {
            if (!transfer(write, out, static_cast<const char*>(bytes), size)) {
                _exit(job_threw);
            }
        });
    } catch (...) {
        _exit(job_threw);
    }
    _exit(EXIT_SUCCESS); // no destructors, no flushing: those are the parent's
}

} // namespace detail

namespace {

using namespace detail;

[[noreturn]] void refuse(const char* what) {
    throw std::system_error{errno, std::generic_category(), what};
}

ChildEnd wait_for(pid_t child) {
    int status = 0;
    pid_t ended = 0;
    do {
        ended = waitpid(child, &status, 0);
    } while (ended < 0 && errno == EINTR);
    if (ended < 0) { // a host that ignores SIGCHLD leaves nothing to wait for
        return {};
    }
    return {false, WIFSIGNALED(status) ? WTERMSIG(status) : 0, WIFEXITED(status) ? WEXITSTATUS(status) : 0};
}

/// Returns when there is something to read, or the other side is gone. Throws Interrupted meanwhile.
void wait_to_read(int descriptor) {
    constexpr int milliseconds = 50;
    pollfd watched{descriptor, POLLIN, 0};
    do {
        go_on();
    } while (poll(&watched, 1, milliseconds) <= 0);
}

[[noreturn]] void live_as_child(pid_t parent, Descriptor& in, Descriptor& out,
                                const std::function<void(const Send&)>& job) {
    in.close_now(); // else the pipe stays open after the parent's end
    // Away from the standard streams, in case the host had closed one.
    const Descriptor far{fcntl(out.number(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1)};
    out.close_now();
    reset_signals();
    die_with(parent);
    // The parent asks whether to go on; what is done is counted for it.
    const WatchScope unwatched{{nullptr, current_watch().count}};
    run_job(far.number(), job);
}

/// Ends the process: it has said all. Nothing is allocated, as memory may be what was short.
[[noreturn]] void answer(const Send& send, std::string_view text, int exit_code) {
    const std::size_t size = text.size();
    send(&size, sizeof size);
    send(text.data(), size);
    _exit(exit_code);
}

void answer_by(const std::function<std::string()>& job, const Send& send) {
    try {
        answer(send, job(), EXIT_SUCCESS);
    } catch (const Error& error) {
        answer(send, error.what(), static_cast<int>(error.failure()));
    } catch (const std::exception& error) { // out of memory, mostly
        answer(send, error.what(), static_cast<int>(Failure::geometry));
    }
}

bool hear(std::string& text, const Receive& receive) {
    std::size_t size = 0;
    if (!receive(&size, sizeof size)) {
        return false;
    }
    text.resize(size);
    return receive(text.data(), size);
}

} // namespace

ChildEnd run_in_child(const std::function<void(const Send&)>& job,
                      const std::function<bool(const Receive&)>& receive) {
    // One start at a time: a child that inherited the writing end of another's pipe would keep it open.
    static std::mutex starting;
    std::unique_lock start{starting};
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        refuse("no pipe");
    }
    Descriptor in{ends[0]};
    Descriptor out{ends[1]};
    constexpr int roomy = 1 << 20; // fewer switches between the two; no harm when refused
    fcntl(out.number(), F_SETPIPE_SZ, roomy);

    prepare_sanitizer_for_fork();
    const pid_t parent = getpid();
    const pid_t id = fork();
    if (id < 0) {
        refuse("no process");
    }
    if (id == 0) {
        start.unlock(); // the copy of it, for children of the child
        live_as_child(parent, in, out, job);
    }
    out.close_now(); // so that the child's end is the end of the stream
    start.unlock();
    try {
        const bool received = receive([&](void* bytes, std::size_t size) {
            wait_to_read(in.number());
            return transfer(read, in.number(), static_cast<char*>(bytes), size);
        });
        in.close_now();
        ChildEnd end = wait_for(id);
        end.received = received;
        if (end.signal == SIGINT || end.signal == SIGTERM) {
            hear_of_signal();
        }
        return end;
    } catch (...) {
        kill(id, SIGKILL);
        wait_for(id);
        throw;
    }
}

ChildAnswer ask_child(const std::function<std::string()>& job) {
    ChildAnswer heard;
    heard.end = run_in_child([&](const Send& send) { answer_by(job, send); },
                             [&](const Receive& receive) { return hear(heard.text, receive); });
    return heard;
}

void fall_silent() {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const int silence = open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        dup2(silence, stream);
    }
}

} // namespace slabhull
