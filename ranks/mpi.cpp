// SPDX-License-Identifier: BSD-3-Clause
// The only file that knows MPI.
#include "slabhull/ranks/mpi.h"

#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <fmt/format.h>
#include <mpi.h>
#include <mutex>
#include <thread>

namespace slabhull {

namespace {

using Clock = std::chrono::steady_clock;

/// Bytes in one message: counts are ints.
constexpr std::size_t most_in_message = std::size_t{1} << 30;
constexpr int life_tag = 1;
constexpr int data_tag = 2;

/// Tells the other ranks each second that this process lives, and listens to them: on a thread of its own,
/// so that long work does not count as death. A process that is stopped, or a machine that is gone, is
/// silent.
class Pulse {
public:
    Pulse(int rank, int size, double timeout)
        : rank_{rank}, timeout_{timeout}, heard_(static_cast<std::size_t>(size)) {
        MPI_Comm_dup(MPI_COMM_WORLD, &world_);
        for (auto& heard : heard_) {
            heard = now();
        }
        thread_ = std::thread{[this] { beat(); }};
    }
    Pulse(const Pulse&) = delete;
    Pulse& operator=(const Pulse&) = delete;
    ~Pulse() {
        {
            const std::lock_guard guard{mutex_};
            ended_ = true;
        }
        wake_.notify_all();
        thread_.join();
        MPI_Barrier(world_); // all that was sent has been heard, or is dropped with the communicator
        listen();
        MPI_Comm_free(&world_);
    }

    /// Seconds for which the most silent rank was not heard, and which one that is. They count up to the last
    /// time that this process has listened.
    std::pair<double, int> longest_silence() const {
        const std::int64_t listened = listened_;
        double longest = 0;
        int which = rank_;
        for (std::size_t r = 0; r < heard_.size(); ++r) {
            const double silent =
                static_cast<int>(r) == rank_ ? 0.0 : 1e-3 * static_cast<double>(listened - heard_[r]);
            if (silent > longest) {
                longest = silent;
                which = static_cast<int>(r);
            }
        }
        return {longest, which};
    }

private:
    static std::int64_t now() {
        return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now().time_since_epoch()).count();
    }

    void beat() {
        std::unique_lock lock{mutex_};
        while (!ended_) {
            lock.unlock();
            for (int r = 0; r < static_cast<int>(heard_.size()); ++r) {
                if (r != rank_) {
                    MPI_Request request;
                    MPI_Isend(&rank_, 0, MPI_CHAR, r, life_tag, world_, &request);
                    MPI_Request_free(&request);
                }
            }
            listen();
            lock.lock();
            wake_.wait_for(lock, std::chrono::seconds{1}, [this] { return ended_; });
        }
    }

    /// A process that was stopped itself has heard nobody meanwhile, and nothing follows from that.
    void listen() {
        if (1e-3 * static_cast<double>(now() - listened_) > timeout_ / 2) {
            for (auto& heard : heard_) {
                heard = now();
            }
        }
        int there = 1;
        while (there != 0) {
            MPI_Status status;
            MPI_Iprobe(MPI_ANY_SOURCE, life_tag, world_, &there, &status);
            if (there != 0) {
                MPI_Recv(nullptr, 0, MPI_CHAR, status.MPI_SOURCE, life_tag, world_, MPI_STATUS_IGNORE);
                heard_[static_cast<std::size_t>(status.MPI_SOURCE)] = now();
            }
        }
        listened_ = now();
    }

    int rank_;
    double timeout_;
    MPI_Comm world_ = MPI_COMM_NULL;
    std::vector<std::atomic<std::int64_t>> heard_; ///< when, in milliseconds
    std::atomic<std::int64_t> listened_{now()};
    std::mutex mutex_;
    std::condition_variable wake_;
    bool ended_ = false;
    std::thread thread_;
};

class MpiRank final : public Communicator {
public:
    MpiRank(MPI_Comm world, const Pulse& pulse, double timeout, int rank, int size)
        : Communicator{rank, size}, world_{world}, pulse_{pulse}, timeout_{timeout} {}

protected:
    void exchange(const void* mine, std::size_t bytes, void* all) override {
        MPI_Request request;
        MPI_Iallgather(mine, static_cast<int>(bytes), MPI_BYTE, all, static_cast<int>(bytes), MPI_BYTE,
                       world_, &request);
        wait_for({&request, 1});
    }

    void pass(std::span<const std::span<const std::byte>> to,
              std::span<const std::span<std::byte>> from) override {
        std::vector<MPI_Request> requests;
        for (int step = 0; step < size(); ++step) {
            const auto target = static_cast<std::size_t>((rank() + step) % size());
            const auto source = static_cast<std::size_t>((rank() + size() - step) % size());
            if (step == 0) {
                std::copy_n(to[target].begin(), from[source].size(), from[source].begin());
                continue;
            }
            for (std::size_t at = 0; at < from[source].size(); at += most_in_message) {
                const std::size_t length = std::min(most_in_message, from[source].size() - at);
                MPI_Irecv(from[source].data() + at, static_cast<int>(length), MPI_BYTE,
                          static_cast<int>(source), data_tag, world_, &requests.emplace_back());
            }
            for (std::size_t at = 0; at < to[target].size(); at += most_in_message) {
                const std::size_t length = std::min(most_in_message, to[target].size() - at);
                MPI_Isend(to[target].data() + at, static_cast<int>(length), MPI_BYTE,
                          static_cast<int>(target), data_tag, world_, &requests.emplace_back());
            }
        }
        wait_for(requests);
    }

private:
    /// Sleeps between questions, longer and longer: a rank that waits leaves its core to those that work.
    void wait_for(std::span<MPI_Request> requests) const {
        constexpr std::chrono::microseconds longest{2000};
        std::chrono::microseconds pause{10};
        for (int questions = 0;; ++questions) {
            int done = 0;
            MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
            if (done != 0) {
                return;
            }
            if (questions > 100) {
                std::this_thread::sleep_for(pause);
                pause = std::min(longest, 2 * pause);
                require_life();
            }
        }
    }

    /// One rank tells of a silent one: the lowest that can, unless it does not come to it soon.
    void require_life() const {
        constexpr double soon = 5;
        const auto [silent, which] = pulse_.longest_silence();
        const bool speaks = rank() == (which == 0 ? 1 : 0);
        if (silent > timeout_ + (speaks ? 0 : soon)) {
            fmt::print(stderr, "slabhull: rank {} has not been heard of for {:.0f} s: all ranks end\n", which,
                       silent);
            MPI_Abort(world_, static_cast<int>(Failure::geometry));
        }
    }

    MPI_Comm world_;
    const Pulse& pulse_;
    double timeout_;
};

} // namespace

bool has_mpi() {
    return true;
}

int run_in_mpi(const std::function<int(Communicator&)>& work, double timeout) {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
    int rank = 0;
    int size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (provided < MPI_THREAD_MULTIPLE) {
        MPI_Finalize();
        throw UsageError{
            "this MPI does not let several threads call it (MPI_THREAD_MULTIPLE), which ranks need"};
    }
    int result = 0;
    std::exception_ptr error;
    {
        const Pulse pulse{rank, size, timeout};
        MpiRank ranks{MPI_COMM_WORLD, pulse, timeout, rank, size};
        try {
            result = work(ranks);
        } catch (...) {
            error = std::current_exception();
        }
    }
    MPI_Finalize();
    if (error) {
        std::rethrow_exception(error);
    }
    return result;
}

} // namespace slabhull
