// SPDX-License-Identifier: BSD-3-Clause
// Ranks that are threads of one process.
#include "slabhull/core/communicator.h"
#include "slabhull/core/progress.h"

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

namespace slabhull {

namespace {

/// What the threads of a team share: a place for each to show the others what it has.
class MeetingPlace {
public:
    explicit MeetingPlace(std::size_t ranks) : shown_(ranks) {}

    /// Shows what a rank has; returns when all have shown theirs.
    void show(std::size_t rank, const void* what) {
        shown_[rank] = what;
        wait();
    }
    const void* shown(std::size_t rank) const { return shown_[rank]; }
    /// Returns when all have come.
    void wait() {
        std::unique_lock lock{mutex_};
        const std::uint64_t round = round_;
        if (++here_ == shown_.size()) {
            here_ = 0;
            ++round_;
            all_here_.notify_all();
        } else {
            all_here_.wait(lock, [&] { return round_ != round; });
        }
    }

private:
    std::vector<const void*> shown_;
    std::mutex mutex_;
    std::condition_variable all_here_;
    std::size_t here_ = 0;
    std::uint64_t round_ = 0;
};

class TeamRank final : public Communicator {
public:
    TeamRank(MeetingPlace& place, int rank, int size) : Communicator{rank, size}, place_{place} {}

protected:
    void exchange(const void* mine, std::size_t bytes, void* all) override {
        place_.show(static_cast<std::size_t>(rank()), mine);
        for (std::size_t r = 0; r < static_cast<std::size_t>(size()); ++r) {
            std::memcpy(static_cast<char*>(all) + r * bytes, place_.shown(r), bytes);
        }
        place_.wait(); // before anybody's goes
    }

    void pass(std::span<const std::span<const std::byte>> to,
              std::span<const std::span<std::byte>> from) override {
        place_.show(static_cast<std::size_t>(rank()), to.data());
        for (std::size_t r = 0; r < from.size(); ++r) {
            const auto* ranges = static_cast<const std::span<const std::byte>*>(place_.shown(r));
            const std::span<const std::byte> bytes = ranges[rank()];
            std::copy_n(bytes.begin(), from[r].size(), from[r].begin());
        }
        place_.wait();
    }

private:
    MeetingPlace& place_;
};

} // namespace

void run_team(int ranks, const std::function<void(Communicator&)>& work) {
    const auto count = static_cast<std::size_t>(ranks);
    MeetingPlace place{count};
    std::vector<std::exception_ptr> errors(count);
    std::vector<std::thread> threads;
    for (std::size_t r = 0; r < count; ++r) {
        threads.emplace_back(watched_as_here([&place, &errors, &work, ranks, r] {
            TeamRank rank{place, static_cast<int>(r), ranks};
            try {
                together(rank, [&] { work(rank); });
            } catch (...) {
                errors[r] = std::current_exception();
            }
        }));
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (const std::exception_ptr& error : errors) {
        if (error) {
            std::rethrow_exception(error);
        }
    }
}

} // namespace slabhull
