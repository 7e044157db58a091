// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/progress_meter.h"

#include <algorithm>

namespace slabhull {

namespace {

/// How much of its expected time a stage that does not count is taken to have done at most.
constexpr double nearly_done = 0.95;
/// Largest share of a run that is not at its end.
constexpr double not_yet_whole = 0.999;

} // namespace

ProgressMeter::ProgressMeter(const Listener& listener, double start, double end, int slabs)
    : listener_{listener}, end_{end}, slab_begin_{start}, slab_end_{start} {
    run_.slabs = slabs;
}

Progress ProgressMeter::watch() {
    return [this](const WorkState& work) {
        const std::lock_guard guard{lock_};
        tell(work);
        return true;
    };
}

void ProgressMeter::begin_slab(int slab, double begin, double end) {
    const std::lock_guard guard{lock_};
    if (run_.slab) { // the one before took so long, with what was done beside it
        expected_seconds_ = since_slab_.seconds();
    }
    run_.slab = slab;
    slab_begin_ = begin;
    slab_end_ = end;
    in_stages_ = 0;
    stage_.clear();
    since_slab_ = {};
}

void ProgressMeter::expect_seconds(double seconds) {
    const std::lock_guard guard{lock_};
    if (expected_seconds_ == 0) {
        expected_seconds_ = seconds;
    }
}

void ProgressMeter::hull_built(std::uint64_t cells) {
    const std::lock_guard guard{lock_};
    hull_cells_ += cells;
}

void ProgressMeter::end_slab(const StageClock& clock) {
    const std::lock_guard guard{lock_};
    expected_ = clock.stages();
    stage_seconds_ = clock.total();
}

void ProgressMeter::end() {
    const std::lock_guard guard{lock_};
    run_.work = {"done", 0, 0};
    run_.share = 1;
    run_.cells = hull_cells_;
    run_.seconds = since_begin_.seconds();
    run_.seconds_left = 0;
    listener_.progress(run_);
}

void ProgressMeter::tell(const WorkState& work) {
    if (work.stage != stage_) {
        in_stages_ += expected_of(stage_);
        stage_ = work.stage;
        since_stage_ = {};
    }
    run_.work = work;
    const std::uint64_t of_cap = work.stage == cap_meshing_stage ? work.done : 0;
    run_.cells = std::max(run_.cells, hull_cells_ + of_cap);
    run_.seconds = since_begin_.seconds();
    run_.seconds_left = seconds_left(work);
    if (run_.seconds_left) {
        const double share = run_.seconds / (run_.seconds + *run_.seconds_left);
        run_.share = std::max(run_.share, std::min(share, not_yet_whole));
    }
    listener_.progress(run_);
}

double ProgressMeter::expected_of(const std::string& stage) const {
    const auto found = std::find_if(expected_.begin(), expected_.end(),
                                    [&](const auto& entry) { return entry.first == stage; });
    return found == expected_.end() ? 0 : found->second;
}

std::optional<double> ProgressMeter::seconds_left(const WorkState& work) const {
    if (expected_seconds_ == 0) {
        return std::nullopt;
    }
    const auto passed_of = [](double seconds, double expected) {
        return std::min(seconds, nearly_done * expected);
    };
    double passed = passed_of(since_slab_.seconds(), expected_seconds_);
    if (stage_seconds_ > 0) { // some of them beside others, so that they are longer than the slab
        const double expected = expected_of(stage_);
        const std::optional<double> share = work.share();
        const double in_stage = share ? *share * expected : passed_of(since_stage_.seconds(), expected);
        passed = std::max(passed, (in_stages_ + in_stage) / stage_seconds_ * expected_seconds_);
    }
    const double slabs_left = (end_ - slab_end_) / (slab_end_ - slab_begin_);
    return std::max(0.0, expected_seconds_ - passed) + slabs_left * expected_seconds_;
}

} // namespace slabhull
