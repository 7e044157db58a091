// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace slabhull {

/// Told what long work is doing, some twenty times a second, such as "cap meshing"; empty between two stages.
/// Returns whether to go on. Called by one thread at a time, not always by the same one. It must not throw.
using Progress = std::function<bool(const std::string& stage)>;

/// Work was stopped because its Progress said so. Nothing is left behind: no file, no process, no change of
/// state.
class Interrupted : public Error {
public:
    Interrupted() : Error{Failure::interrupted, "interrupted"} {}
};

namespace detail {
class ProgressWatch;
using ProgressWatchPointer = std::shared_ptr<ProgressWatch>;
/// The watch over this thread's work; null: none.
ProgressWatchPointer current_watch();

/// While it lives, this thread's work is watched by `watch`.
class WatchScope {
public:
    explicit WatchScope(ProgressWatchPointer watch);
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;
    ~WatchScope();

private:
    ProgressWatchPointer before_;
};
} // namespace detail

/// While it lives, what this thread does is watched by `progress`: parallel loops and child processes that it
/// starts, too. A scope inside another asks both. An empty function marks work that must come to its end:
/// then nobody is asked.
class ProgressScope {
public:
    explicit ProgressScope(Progress progress);

private:
    detail::WatchScope scope_;
};

/// The same work for another thread to do, watched there as this thread is watched now.
template<class Work>
auto watched_as_here(Work work) {
    return [work = std::move(work), watch = detail::current_watch()] {
        const detail::WatchScope scope{watch};
        return work();
    };
}

/// Names what is done from here on.
void enter_stage(const std::string& stage);

/// To be called now and then by long loops: throws Interrupted when the work is to stop. Costs some 30 ns.
void go_on();

} // namespace slabhull
