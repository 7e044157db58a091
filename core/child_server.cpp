// SPDX-License-Identifier: BSD-3-Clause
// A copy of this process, made once, forks for each order a keeper, and that the worker, for whose end it
// waits:
//
//     host --order--> server --fork--> keeper --fork--> worker
//
// The order brings two sockets: for the worker's bytes, and for news of it. The server has no children to
// wait for and nothing to remember; it ends when the host's end of its socket is closed.
#include "core/child_server.h"

#include "core/child_pipes.h"
#include "core/heap_pages.h"
#include "core/sanitizer_fork.h"

#include "slabhull/core/child_process.h"
#include "slabhull/core/progress.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

namespace slabhull {

namespace {

using namespace detail;

constexpr int milliseconds_between = 50; ///< in which the host is asked whether to go on

/// What the host sends to the server, with two sockets.
struct Order {
    FreshJob job = nullptr; ///< the same address in all copies
    std::uint64_t request_bytes = 0;
};

/// What keeper and worker tell the host.
struct News {
    enum class Kind : std::uint32_t { started, counted, ended };
    Kind kind = Kind::started;
    std::int32_t number = 0; ///< started: the worker's process; ended: its status
    std::uint64_t count = 0; ///< counted: of work; ended: largest memory in bytes
    double cpu_seconds = 0;  ///< ended
};

std::mutex fresh_usage_lock;
FreshChildrenUsage fresh_usage;

void tell(int descriptor, const News& news) {
    ::send(descriptor, &news, sizeof news, MSG_NOSIGNAL);
}

/// A message of an order and two sockets, either way.
class OrderMessage {
public:
    explicit OrderMessage(const Order& order = {}) : order_{order} {
        message_.msg_iov = &text_;
        message_.msg_iovlen = 1;
        message_.msg_control = control_.data();
        message_.msg_controllen = control_.size();
    }
    OrderMessage(const OrderMessage&) = delete;
    OrderMessage& operator=(const OrderMessage&) = delete;

    bool send(int server, std::array<int, 2> sockets) {
        cmsghdr* const header = CMSG_FIRSTHDR(&message_);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof sockets);
        std::memcpy(CMSG_DATA(header), sockets.data(), sizeof sockets);
        return ::sendmsg(server, &message_, MSG_NOSIGNAL) == sizeof order_;
    }

    /// Empty when the host is gone.
    std::optional<Order> receive(int host, std::array<int, 2>& sockets) {
        ssize_t size = 0;
        do {
            size = ::recvmsg(host, &message_, MSG_CMSG_CLOEXEC);
        } while (size < 0 && errno == EINTR);
        const cmsghdr* const header = CMSG_FIRSTHDR(&message_);
        if (size != sizeof order_ || header == nullptr || header->cmsg_len != CMSG_LEN(sizeof sockets)) {
            return std::nullopt;
        }
        std::memcpy(sockets.data(), CMSG_DATA(header), sizeof sockets);
        return order_;
    }

private:
    Order order_;
    iovec text_{&order_, sizeof order_};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> control_{};
    msghdr message_{};
};

// --- in the server, its keepers and workers -------------------------------------------------------

[[noreturn]] void work(const Order& order, int data, int news) {
    constexpr std::size_t heap = std::size_t{256} << 20; // a million tetrahedra of TetGen's
    grow_heap_in_huge_pages(heap);
    std::vector<std::byte> request(order.request_bytes);
    if (!transfer(::read, data, reinterpret_cast<char*>(request.data()), request.size())) {
        _exit(job_threw);
    }
    const auto told = [news](std::uint64_t added) { tell(news, {News::Kind::counted, 0, added, 0}); };
    const WatchScope watched{{nullptr, count_told_to(told)}};
    run_job(data, [&](const Send& send) { order.job(request, send); });
}

[[noreturn]] void keep(const Order& order, Descriptor data, Descriptor news) {
    const pid_t keeper = ::getpid();
    const pid_t worker = ::fork();
    if (worker == 0) {
        die_with(keeper);
        reset_signals();
        work(order, data.number(), news.number());
    }
    data.close_now(); // so that the worker's end is the end of the stream
    int status = 0;
    rusage used{};
    if (worker > 0) {
        tell(news.number(), {News::Kind::started, worker, 0, 0});
        while (::wait4(worker, &status, 0, &used) < 0 && errno == EINTR) {
        }
    }
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    tell(news.number(), {News::Kind::ended, worker > 0 ? status : W_EXITCODE(job_threw, 0),
                         static_cast<std::uint64_t>(used.ru_maxrss) * 1024,
                         seconds(used.ru_utime) + seconds(used.ru_stime)});
    _exit(EXIT_SUCCESS);
}

/// Closes all files but this one, which becomes number 3; the standard streams lead nowhere.
void hold_only(int descriptor) {
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        ::dup2(nowhere, stream);
    }
    constexpr int kept = STDERR_FILENO + 1;
    if (descriptor != kept) {
        ::dup2(descriptor, kept);
    }
    ::close_range(kept + 1, ~0U, 0);
}

[[noreturn]] void serve(int socket) {
    hold_only(socket);
    Descriptor host{STDERR_FILENO + 1};
    std::signal(SIGCHLD, SIG_DFL);
    sigset_t of_terminals; // which end the host, and that ends us
    sigemptyset(&of_terminals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        sigaddset(&of_terminals, number);
    }
    ::sigprocmask(SIG_BLOCK, &of_terminals, nullptr);
    const pid_t server = ::getpid();
    std::array<int, 2> sockets{};
    while (const std::optional<Order> order = OrderMessage{}.receive(host.number(), sockets)) {
        Descriptor data{sockets[0]};
        Descriptor news{sockets[1]};
        if (::fork() == 0) {
            die_with(server);
            host.close_now();
            keep(*order, std::move(data), std::move(news));
        }
        while (::waitpid(-1, nullptr, WNOHANG) > 0) { // keepers that have ended
        }
    }
    _exit(EXIT_SUCCESS);
}

// --- in the host ----------------------------------------------------------------------------------

/// The way to the server of this process.
class Server {
public:
    static Server& instance() {
        static Server server;
        return server;
    }

    void start() {
        const std::lock_guard guard{lock_};
        if (!is_ours()) {
            launch();
        }
    }

    /// False when no server can be had.
    bool order(const Order& order, std::array<int, 2> sockets) {
        const std::lock_guard guard{lock_};
        for (int attempt = 0; attempt < 2; ++attempt) {
            if ((is_ours() || launch()) && OrderMessage{order}.send(host_.number(), sockets)) {
                return true;
            }
            host_.close_now(); // it was killed
        }
        return false;
    }

private:
    /// Not the parent's, which a copy of that has, too.
    bool is_ours() const { return host_.number() >= 0 && owner_ == ::getpid(); }

    bool launch() {
        host_.close_now();
        std::array<int, 2> ends{};
        if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
            return false;
        }
        Descriptor mine{ends[0]};
        const Descriptor its{ends[1]};
        prepare_sanitizer_for_fork();
        const pid_t child = ::fork();
        if (child < 0) {
            return false;
        }
        if (child == 0) {
            if (::fork() == 0) { // nobody has to wait for a grandchild
                serve(its.number());
            }
            _exit(EXIT_SUCCESS);
        }
        while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
        }
        host_ = std::move(mine);
        owner_ = ::getpid();
        return true;
    }

    std::mutex lock_;
    Descriptor host_;
    pid_t owner_ = 0;
};

/// A worker as the host knows it.
class Worker {
public:
    Worker(Descriptor data, Descriptor news) : data_{std::move(data)}, news_{std::move(news)} {}

    bool send(const Request& request) {
        const auto write = [](int socket, const char* bytes, std::size_t size) {
            return ::send(socket, bytes, size, MSG_NOSIGNAL);
        };
        for (const std::span<const std::byte> part : request) {
            if (!transfer(write, data_.number(), reinterpret_cast<const char*>(part.data()), part.size())) {
                return false;
            }
        }
        return true;
    }

    bool receive(void* bytes, std::size_t size) {
        while (!hear(data_.number())) {
        }
        return transfer(::read, data_.number(), static_cast<char*>(bytes), size);
    }

    /// How it ended; waits for that.
    ChildEnd end() {
        data_.close_now();
        while (!ended_ && !lost_) {
            hear(-1);
        }
        if (!ended_) { // keeper and server are gone
            return {false, SIGKILL, 0};
        }
        const int status = ended_->number;
        const std::lock_guard guard{fresh_usage_lock};
        fresh_usage.cpu_seconds += ended_->cpu_seconds;
        fresh_usage.peak_bytes = std::max<std::size_t>(fresh_usage.peak_bytes, ended_->count);
        return {false, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                WIFEXITED(status) ? WEXITSTATUS(status) : 0};
    }

    /// Ends it.
    void stop() {
        const ProgressScope to_the_end{{}};
        while (!process_ && !lost_) {
            hear(-1);
        }
        if (process_) {
            ::kill(*process_, SIGKILL);
        }
        end();
    }

private:
    /// Waits a moment for bytes of `data`, and hears news; whether there are bytes, or no more will come.
    bool hear(int data) {
        go_on();
        std::array<pollfd, 2> watched{pollfd{lost_ ? -1 : news_.number(), POLLIN, 0},
                                      pollfd{data, POLLIN, 0}};
        if (::poll(watched.data(), watched.size(), milliseconds_between) <= 0) {
            return false;
        }
        if (watched[0].revents != 0) {
            take_news();
        }
        return watched[1].revents != 0;
    }

    void take_news() {
        News news;
        if (::recv(news_.number(), &news, sizeof news, 0) != sizeof news) {
            lost_ = true;
        } else if (news.kind == News::Kind::started) {
            process_ = news.number;
        } else if (news.kind == News::Kind::counted) {
            work_done(news.count);
        } else {
            ended_ = news;
        }
    }

    Descriptor data_;
    Descriptor news_;
    std::optional<pid_t> process_;
    std::optional<News> ended_;
    bool lost_ = false;
};

std::optional<Worker> hire(const Order& order) {
    std::array<int, 2> data{};
    std::array<int, 2> news{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, data.data()) != 0) {
        return std::nullopt;
    }
    Descriptor my_data{data[0]};
    const Descriptor its_data{data[1]};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, news.data()) != 0) {
        return std::nullopt;
    }
    Descriptor my_news{news[0]};
    const Descriptor its_news{news[1]};
    if (!Server::instance().order(order, {its_data.number(), its_news.number()})) {
        return std::nullopt;
    }
    return Worker{std::move(my_data), std::move(my_news)};
}

std::vector<std::byte> joined_request(const Request& request) {
    std::vector<std::byte> all;
    for (const std::span<const std::byte> part : request) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

} // namespace

FreshChildrenUsage usage_of_fresh_children() {
    const std::lock_guard guard{fresh_usage_lock};
    return fresh_usage;
}

void start_child_server() {
    Server::instance().start();
}

ChildEnd run_in_fresh_child(FreshJob job, const Request& request,
                            const std::function<bool(const Receive&)>& receive) {
    std::uint64_t size = 0;
    for (const std::span<const std::byte> part : request) {
        size += part.size();
    }
    std::optional<Worker> worker = hire({job, size});
    if (!worker) {
        const std::vector<std::byte> all = joined_request(request);
        return run_in_child([&](const Send& send) { job(all, send); }, receive);
    }
    try {
        const bool received = worker->send(request) && receive([&](void* bytes, std::size_t count) {
                                  return worker->receive(bytes, count);
                              });
        ChildEnd end = worker->end();
        end.received = received;
        if (end.signal == SIGINT || end.signal == SIGTERM) {
            hear_of_signal();
        }
        return end;
    } catch (...) {
        worker->stop();
        throw;
    }
}

} // namespace slabhull
