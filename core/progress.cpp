// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/progress.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <utility>

namespace slabhull {

namespace detail {

class ProgressWatch {
public:
    ProgressWatch(Progress progress, ProgressWatchPointer outer)
        : progress_{std::move(progress)}, outer_{std::move(outer)} {}

    void enter(const std::string& stage) {
        {
            const std::lock_guard guard{lock_};
            stage_ = stage;
        }
        next_ = 0;
        if (outer_) {
            outer_->enter(stage);
        }
    }

    bool goes_on() {
        if (!progress_) {
            return true;
        }
        if (!stopped_ && is_time()) {
            const std::lock_guard guard{lock_};
            if (!stopped_ && !progress_(stage_)) {
                stopped_ = true;
            }
        }
        return !stopped_ && (!outer_ || outer_->goes_on());
    }

private:
    /// True for one thread in each twentieth of a second.
    bool is_time() {
        using namespace std::chrono;
        const std::int64_t now = steady_clock::now().time_since_epoch() / milliseconds{1};
        std::int64_t next = next_;
        constexpr std::int64_t between = 50;
        return now >= next && next_.compare_exchange_strong(next, now + between);
    }

    Progress progress_;
    ProgressWatchPointer outer_;
    std::mutex lock_;
    std::string stage_;
    std::atomic<std::int64_t> next_{0}; ///< when to ask again, in milliseconds
    std::atomic<bool> stopped_{false};
};

namespace {
thread_local ProgressWatchPointer watch;
}

ProgressWatchPointer current_watch() {
    return watch;
}

WatchScope::WatchScope(ProgressWatchPointer next) : before_{std::exchange(watch, std::move(next))} {}

WatchScope::~WatchScope() {
    watch = std::move(before_);
}

} // namespace detail

ProgressScope::ProgressScope(Progress progress)
    : scope_{std::make_shared<detail::ProgressWatch>(std::move(progress), detail::current_watch())} {}

void enter_stage(const std::string& stage) {
    if (detail::watch) {
        detail::watch->enter(stage);
    }
    go_on();
}

void go_on() {
    if (detail::watch && !detail::watch->goes_on()) {
        throw Interrupted{};
    }
}

} // namespace slabhull
