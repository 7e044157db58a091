// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace slabhull {

/// What long work is doing.
struct WorkState {
    std::string stage;          ///< such as "cap meshing"; empty before the first
    std::uint64_t done = 0;     ///< of what the stage counts, mostly cells
    std::uint64_t expected = 0; ///< estimated total of the same; 0 where the stage does not count

    /// How much of the stage is done, in [0, 1]; empty where it does not count.
    std::optional<double> share() const;
};

/// Told what long work is doing, some twenty times a second. Returns whether to go on. Called by one thread
/// at a time, not always by the same one. It must not throw.
using Progress = std::function<bool(const WorkState& state)>;

/// Work was stopped because its Progress said so. Nothing is left behind: no file, no process, no change of
/// state.
class Interrupted : public Error {
public:
    Interrupted() : Error{Failure::interrupted, "interrupted"} {}
};

namespace detail {
class ProgressWatch;
class StageCount;

/// Who watches a thread's work, and where that is counted; both may be null.
struct Watched {
    std::shared_ptr<ProgressWatch> watch;
    std::shared_ptr<StageCount> count;
};
/// How this thread's work is watched.
Watched current_watch();
/// A count that is told, from time to time, by calls of `tell` with what was added.
std::shared_ptr<StageCount> count_told_to(std::function<void(std::uint64_t added)> tell);

/// While it lives, this thread's work is watched so.
class WatchScope {
public:
    explicit WatchScope(Watched watched);
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;
    ~WatchScope();

private:
    Watched before_;
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
    return [work = std::move(work), watched = detail::current_watch()] {
        const detail::WatchScope scope{watched};
        return work();
    };
}

/// Names what is done from here on. `expected` is how much there is to do, see work_done().
void enter_stage(const std::string& stage, std::uint64_t expected = 0);

/// Says how much this stage has to do, where that was not known when it was entered.
void expect_work(std::uint64_t expected);

/// Says that so much more is done of what the stage counts. Child processes may count, too. Costs some 10 ns.
void work_done(std::uint64_t count);

/// Work beside the stage that is shown, on a thread of its own: counted, and shown by show() only.
class BackgroundStage {
public:
    explicit BackgroundStage(std::string stage, std::uint64_t expected = 0);
    /// Shows this stage from here on, as enter_stage() does.
    void show() const;
    /// How much of it is done.
    std::uint64_t done() const;
    /// The same work, to be run by another thread. It is counted for this stage, and stopped as this thread's
    /// work is; stages that it enters are not shown.
    template<class Work>
    auto counted(Work work) const {
        return [work = std::move(work), watched = watched_behind()]() mutable {
            const detail::WatchScope scope{watched};
            return work();
        };
    }

private:
    detail::Watched watched_behind() const;

    std::string stage_;
    std::shared_ptr<detail::StageCount> count_;
};

/// To be called now and then by long loops: throws Interrupted when the work is to stop. Costs some 30 ns.
void go_on();

} // namespace slabhull
