// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

/// The ranks that do one job together: processes on one or many machines, or the threads of a team. Each has
/// a Communicator of its own.
///
/// All functions but rank() and size() are collective: every rank calls the same ones in the same order, and
/// each waits until all have come. Results are those of all ranks in the order of ranks, so that sums of
/// floating-point numbers are the same on every rank and in every run. If a rank fails instead (see
/// together()), they throw its error on all ranks. A rank that waits sleeps; it can be interrupted (go_on())
/// before it waits, not while.
class Communicator {
public:
    Communicator(int rank, int size) : rank_{rank}, size_{size} {}
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;
    virtual ~Communicator() = default;

    int rank() const { return rank_; }
    int size() const { return size_; }
    /// Whether this is rank 0, which speaks for all.
    bool first() const { return rank_ == 0; }
    /// Bytes of lists that this rank has sent to others so far; what little each call needs beside is not
    /// counted.
    std::uint64_t sent_bytes() const { return sent_bytes_; }
    /// How often this rank has met the others so far.
    std::uint64_t meetings() const { return meetings_; }

    void barrier() { agree(Call::barrier, 0); }

    /// A value of each rank.
    template<class T>
    std::vector<T> gather(const T& mine) {
        static_assert(std::is_trivially_copyable_v<T>);
        agree(Call::gather, sizeof(T));
        std::vector<T> all(static_cast<std::size_t>(size_));
        exchange(&mine, sizeof(T), all.data());
        return all;
    }
    template<class T>
    T sum(const T& mine) {
        const std::vector<T> all = gather(mine);
        T total{};
        for (const T& each : all) {
            total += each;
        }
        return total;
    }
    template<class T>
    T min(const T& mine) {
        const std::vector<T> all = gather(mine);
        return *std::min_element(all.begin(), all.end());
    }
    template<class T>
    T max(const T& mine) {
        const std::vector<T> all = gather(mine);
        return *std::max_element(all.begin(), all.end());
    }
    /// The sum over the ranks before this one. Throws LimitError where integers would overflow.
    template<class T>
    T sum_before(const T& mine) {
        const std::vector<T> all = gather(mine);
        T total{};
        for (std::size_t r = 0; r < static_cast<std::size_t>(rank_); ++r) {
            if constexpr (std::is_integral_v<T>) {
                if (all[r] > 0 && total > std::numeric_limits<T>::max() - all[r]) {
                    throw LimitError{"a sum over ranks does not fit its type"};
                }
            }
            total += all[r];
        }
        return total;
    }

    /// The list of each rank.
    template<class T>
    std::vector<Array<T>> all_gather(std::span<const T> mine) {
        const std::vector<std::span<const T>> to(static_cast<std::size_t>(size_), mine);
        return pass_on<T>(Call::all_gather, to);
    }
    /// `to` has a list for each rank; returns what each rank had for this one.
    template<class T>
    std::vector<Array<T>> all_to_all(const std::vector<Array<T>>& to) {
        return pass_on<T>(Call::all_to_all, {to.begin(), to.end()});
    }
    template<class T>
    std::vector<Array<T>> all_to_all(const std::vector<std::span<const T>>& to) {
        return pass_on<T>(Call::all_to_all, to);
    }
    /// The list that rank `root` has. In each of log2(size()) steps, the ranks that have it double.
    template<class T>
    Array<T> broadcast(std::span<const T> list, int root) {
        const int place = (rank_ - root + size_) % size_;
        const auto rank_at = [&](int other) { return static_cast<std::size_t>((other + root) % size_); };
        Array<T> here;
        if (rank_ == root) {
            here.assign(list.begin(), list.end());
        }
        for (int have = 1; have < size_; have *= 2) {
            std::vector<std::span<const T>> to(static_cast<std::size_t>(size_));
            if (place < have && place + have < size_) {
                to[rank_at(place + have)] = here;
            }
            std::vector<Array<T>> from = pass_on<T>(Call::broadcast, to);
            if (have <= place && place < 2 * have) {
                here = std::move(from[rank_at(place - have)]);
            }
        }
        return here;
    }

    /// While it lives, work goes on in which any rank may fail alone: see together().
    class Scope {
    public:
        explicit Scope(Communicator& ranks) : ranks_{ranks} { ++ranks_.depth_; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
        ~Scope();

    private:
        Communicator& ranks_;
    };
    /// Tells the others of an error that this rank alone may have, and throws the error of the lowest rank
    /// that has one. Called by together().
    [[noreturn]] void fail(const std::exception_ptr& error);

protected:
    // What an implementation does. Both are collective, and sizes agree.

    /// Writes `bytes` bytes of each rank to `all`, in order.
    virtual void exchange(const void* mine, std::size_t bytes, void* all) = 0;
    /// Sends a range of bytes to each rank and receives one from each; of any length.
    virtual void pass(std::span<const std::span<const std::byte>> to,
                      std::span<const std::span<std::byte>> from) = 0;

private:
    enum class Call : std::int32_t { barrier, gather, all_gather, all_to_all, broadcast };

    /// Meets the other ranks before each call. Throws the error of a rank that comes with one, and
    /// std::logic_error where ranks make different calls.
    void agree(Call call, std::uint64_t bytes);
    [[noreturn]] void throw_failure(int of, const std::exception_ptr& own);

    template<class T>
    std::vector<Array<T>> pass_on(Call call, const std::vector<std::span<const T>>& to) {
        static_assert(std::is_trivially_copyable_v<T>);
        agree(call, sizeof(T));
        const auto ranks = static_cast<std::size_t>(size_);
        std::vector<std::uint64_t> mine(ranks);
        std::vector<std::uint64_t> lengths(ranks * ranks);
        for (std::size_t r = 0; r < ranks; ++r) {
            mine[r] = to[r].size();
        }
        exchange(mine.data(), ranks * sizeof(std::uint64_t), lengths.data());
        std::vector<Array<T>> from(ranks);
        std::vector<std::span<const std::byte>> out(ranks);
        std::vector<std::span<std::byte>> in(ranks);
        for (std::size_t r = 0; r < ranks; ++r) {
            from[r].resize(lengths[r * ranks + static_cast<std::size_t>(rank_)]);
            out[r] = std::as_bytes(to[r]);
            sent_bytes_ += r != static_cast<std::size_t>(rank_) ? out[r].size() : 0;
            in[r] = std::as_writable_bytes(std::span<T>{from[r]});
        }
        pass(out, in);
        return from;
    }

    int rank_;
    int size_;
    std::uint64_t sent_bytes_ = 0;
    std::uint64_t meetings_ = 0;
    std::int32_t depth_ = 0;        ///< scopes around the work
    std::exception_ptr failure_{};  ///< that all ranks have learnt of and still unwind from, ...
    std::int32_t failed_depth_ = 0; ///< ... down to this depth
};

/// Does work in which any rank may fail alone. If one does, the error of the lowest that does is thrown on
/// all: an Error of the same class, with its entities, std::bad_alloc, or std::runtime_error. All ranks call
/// it; scopes may be nested. Ends with a barrier.
template<class Work>
auto together(Communicator& ranks, const Work& work) {
    const Communicator::Scope scope{ranks};
    try {
        if constexpr (std::is_void_v<decltype(work())>) {
            work();
            ranks.barrier();
        } else {
            auto result = work();
            ranks.barrier();
            return result;
        }
    } catch (...) {
        ranks.fail(std::current_exception());
    }
}

/// One rank alone: what work in ranks is without others.
class SoleRank final : public Communicator {
public:
    SoleRank() : Communicator{0, 1} {}

protected:
    void exchange(const void* mine, std::size_t bytes, void* all) override;
    void pass(std::span<const std::span<const std::byte>> to,
              std::span<const std::span<std::byte>> from) override;
};

/// Runs `work` on so many threads of this process, each with the communicator of its rank, and waits for all.
/// If one fails outside together(), too, the lowest rank's error is thrown. For tests, and where there is no
/// MPI.
void run_team(int ranks, const std::function<void(Communicator&)>& work);

} // namespace slabhull
