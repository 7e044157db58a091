// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <new>
#include <utility>

#include <sys/mman.h>

namespace slabhull {

std::optional<double> WorkState::share() const {
    if (expected == 0) {
        return std::nullopt;
    }
    return std::min(1.0, static_cast<double>(done) / static_cast<double>(expected));
}

namespace detail {

/// What a stage has done. It lies in memory that child processes share.
class StageCount {
public:
    explicit StageCount(std::uint64_t expected) {
        void* page = mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (page != MAP_FAILED) {
            counts_ = new (page) Counts{{0}, {expected}};
        }
    }
    explicit StageCount(std::function<void(std::uint64_t)> tell) : tell_{std::move(tell)} {}
    StageCount(const StageCount&) = delete;
    StageCount& operator=(const StageCount&) = delete;
    ~StageCount() {
        if (counts_ != nullptr) {
            munmap(counts_, sizeof(Counts));
        }
    }

    void add(std::uint64_t done) {
        constexpr std::uint64_t worth_telling = 1 << 12;
        if (tell_) { // else many threads may be here at once
            untold_ += done;
            if (untold_ >= worth_telling) {
                tell_(std::exchange(untold_, 0));
            }
        }
        if (counts_ != nullptr) {
            counts_->done.fetch_add(done, std::memory_order_relaxed);
        }
    }
    void expect(std::uint64_t expected) {
        if (counts_ != nullptr) {
            counts_->expected = expected;
        }
    }
    std::pair<std::uint64_t, std::uint64_t> done_of_expected() const {
        return counts_ == nullptr ? std::pair<std::uint64_t, std::uint64_t>{}
                                  : std::pair{counts_->done.load(), counts_->expected.load()};
    }

private:
    struct Counts {
        std::atomic<std::uint64_t> done;
        std::atomic<std::uint64_t> expected;
    };
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "processes share it");

    Counts* counts_ = nullptr;                ///< null where there was no memory: then nothing is counted
    std::function<void(std::uint64_t)> tell_; ///< of a process with one thread
    std::uint64_t untold_ = 0;
};

class ProgressWatch {
public:
    ProgressWatch(Progress progress, std::shared_ptr<ProgressWatch> outer, bool shows = true)
        : progress_{std::move(progress)}, outer_{std::move(outer)}, shows_{shows &&
                                                                           (!outer_ || outer_->shows_)} {}

    /// Whether stages are shown: not those of work in the background.
    bool shows() const { return shows_; }

    void enter(const std::string& stage, const std::shared_ptr<StageCount>& count) {
        {
            const std::lock_guard guard{lock_};
            stage_ = stage;
            count_ = count;
        }
        next_ = 0;
        if (outer_) {
            outer_->enter(stage, count);
        }
    }

    bool goes_on() {
        if (!progress_) {
            return true;
        }
        if (!stopped_ && is_time()) {
            const std::lock_guard guard{lock_};
            if (!stopped_ && !progress_(state())) {
                stopped_ = true;
            }
        }
        return !stopped_ && (!outer_ || outer_->goes_on());
    }

private:
    WorkState state() const {
        const auto [done, expected] =
            count_ ? count_->done_of_expected() : std::pair<std::uint64_t, std::uint64_t>{};
        return {stage_, done, expected};
    }

    /// True for one thread in each twentieth of a second.
    bool is_time() {
        using namespace std::chrono;
        const std::int64_t now = steady_clock::now().time_since_epoch() / milliseconds{1};
        std::int64_t next = next_;
        constexpr std::int64_t between = 50;
        return now >= next && next_.compare_exchange_strong(next, now + between);
    }

    Progress progress_;
    std::shared_ptr<ProgressWatch> outer_;
    bool shows_;
    std::mutex lock_;
    std::string stage_;
    std::shared_ptr<StageCount> count_;
    std::atomic<std::int64_t> next_{0}; ///< when to ask again, in milliseconds
    std::atomic<bool> stopped_{false};
};

namespace {
thread_local Watched watched;
}

Watched current_watch() {
    return watched;
}

std::shared_ptr<StageCount> count_told_to(std::function<void(std::uint64_t)> tell) {
    return std::make_shared<StageCount>(std::move(tell));
}

WatchScope::WatchScope(Watched next) : before_{std::exchange(watched, std::move(next))} {}

WatchScope::~WatchScope() {
    watched = std::move(before_);
}

} // namespace detail

ProgressScope::ProgressScope(Progress progress)
    : scope_{{std::make_shared<detail::ProgressWatch>(std::move(progress), detail::watched.watch),
              detail::watched.count}} {}

void enter_stage(const std::string& stage, std::uint64_t expected) {
    auto& [watch, count] = detail::watched;
    if (watch && !watch->shows()) {
        return go_on(); // all is counted for the stage in the background
    }
    count = watch ? std::make_shared<detail::StageCount>(expected) : nullptr;
    if (watch) {
        watch->enter(stage, count);
    }
    go_on();
}

void expect_work(std::uint64_t expected) {
    if (detail::watched.count) {
        detail::watched.count->expect(expected);
    }
}

void work_done(std::uint64_t count) {
    if (detail::watched.count) {
        detail::watched.count->add(count);
    }
}

BackgroundStage::BackgroundStage(std::string stage, std::uint64_t expected)
    : stage_{std::move(stage)}, count_{std::make_shared<detail::StageCount>(expected)} {}

detail::Watched BackgroundStage::watched_behind() const {
    const auto goes_on = [](const WorkState&) { return true; };
    constexpr bool shows = false;
    return {std::make_shared<detail::ProgressWatch>(goes_on, detail::watched.watch, shows), count_};
}

void BackgroundStage::show() const {
    if (detail::watched.watch && detail::watched.watch->shows()) {
        detail::watched.count = count_;
        detail::watched.watch->enter(stage_, count_);
    }
    go_on();
}

std::uint64_t BackgroundStage::done() const {
    return count_->done_of_expected().first;
}

void go_on() {
    if (detail::watched.watch && !detail::watched.watch->goes_on()) {
        throw Interrupted{};
    }
}

} // namespace slabhull
