// SPDX-License-Identifier: BSD-3-Clause
#include "child_process.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace slabhull {

namespace {

constexpr int job_threw = 3;

[[noreturn]] void refuse(const char* what) {
    throw GeometryError{
        fmt::format("cannot start a child process for the mesher: {}: {}", what, std::strerror(errno))};
}

/// A process that is ended and waited for at the latest when its handle goes.
class Child {
public:
    explicit Child(pid_t id) : id_{id} {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ > 0) {
            kill(id_, SIGKILL);
            wait();
        }
    }

    ChildEnd wait() {
        int status = 0;
        pid_t ended = 0;
        do {
            ended = waitpid(id_, &status, 0);
        } while (ended < 0 && errno == EINTR);
        id_ = 0;
        if (ended < 0) { // a host that ignores SIGCHLD leaves nothing to wait for
            return {};
        }
        return {false, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                WIFEXITED(status) ? WEXITSTATUS(status) : 0};
    }

private:
    pid_t id_;
};

class Descriptor {
public:
    explicit Descriptor(int number) : number_{number} {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close_now(); }

    int number() const { return number_; }
    void close_now() {
        if (number_ >= 0) {
            close(number_);
        }
        number_ = -1;
    }

private:
    int number_;
};

bool read_all(int from, void* bytes, std::size_t size) {
    auto* place = static_cast<char*>(bytes);
    while (size > 0) {
        const ssize_t got = read(from, place, std::min<std::size_t>(size, std::size_t{1} << 30));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return false;
        }
        place += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

void write_all(int to, const void* bytes, std::size_t size) {
    const auto* place = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t put = write(to, place, std::min<std::size_t>(size, std::size_t{1} << 30));
        if (put < 0 && errno == EINTR) {
            continue;
        }
        if (put <= 0) {
            _exit(job_threw);
        }
        place += put;
        size -= static_cast<std::size_t>(put);
    }
}

/// Makes the copy harmless: the host's signal handlers must not run in it, nothing is printed, no core is
/// left.
void settle_child(pid_t parent) {
    for (int number = 1; number < NSIG; ++number) {
        std::signal(number, SIG_DFL); // fails for a few that nobody can set
    }
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) { // it was gone before the line above
        _exit(job_threw);
    }
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const int silence = open("/dev/null", O_RDWR);
    dup2(silence, STDIN_FILENO);
    dup2(silence, STDOUT_FILENO);
    dup2(silence, STDERR_FILENO);
}

[[noreturn]] void live_as_child(pid_t parent, int pipe_end, const std::function<void(const Send&)>& job) {
    const int out =
        fcntl(pipe_end, F_DUPFD, STDERR_FILENO + 1); // in case the host had closed a standard stream
    settle_child(parent);
    try {
        job([out](const void* bytes, std::size_t size) { write_all(out, bytes, size); });
    } catch (...) {
        _exit(job_threw);
    }
    _exit(EXIT_SUCCESS); // no destructors, no flushing: those are the parent's
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

    const pid_t parent = getpid();
    const pid_t id = fork();
    if (id < 0) {
        refuse("no process");
    }
    if (id == 0) {
        start.unlock(); // the copy of it, for children of the child
        live_as_child(parent, out.number(), job);
    }
    Child child{id};
    out.close_now(); // so that the child's end is the end of the stream
    start.unlock();
    const bool received =
        receive([&](void* bytes, std::size_t size) { return read_all(in.number(), bytes, size); });
    in.close_now();
    ChildEnd end = child.wait();
    end.received = received;
    return end;
}

} // namespace slabhull
