// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/id_runs.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace slabhull {

namespace {

/// Runs are given up when there are many, and shorter than this on average: they would save little, and cost
/// time.
constexpr std::size_t worth_a_run = 16;
constexpr std::size_t many_runs = 64;

} // namespace

void IdRuns::push_back(std::int64_t id) {
    if (!plain_.empty()) {
        plain_.push_back(id);
    } else if (!extends_last_run(id)) {
        runs_.push_back({size_, id, 0});
        if (runs_.size() > many_runs && runs_.size() * worth_a_run > size_) {
            ++size_;
            give_up_runs();
            return;
        }
    }
    grow(1);
}

void IdRuns::grow(std::size_t count) {
    size_ += count;
    while (run_at_block_.size() * block < size_ && plain_.empty()) {
        run_at_block_.push_back(runs_.size() - 1);
    }
}

bool IdRuns::extends_last_run(std::int64_t id) {
    if (runs_.empty()) {
        return false;
    }
    Run& last = runs_.back();
    if (size_ - last.begin == 1 && (id == last.first || id == last.first + 1)) {
        last.step = id - last.first;
    }
    return id == last.at(size_);
}

void IdRuns::give_up_runs() {
    Array<std::int64_t> all(size_);
    copy(0, size_, all.data());
    plain_ = std::move(all);
    runs_ = {};
    run_at_block_ = {};
}

void IdRuns::append(std::span<const std::int64_t> ids) {
    for (const std::int64_t id : ids) {
        push_back(id);
    }
}

void IdRuns::append_run(std::int64_t first, std::size_t count, std::int64_t step) {
    for (; count > 0; --count, first += step) {
        const bool goes_on = plain_.empty() && !runs_.empty() && size_ - runs_.back().begin >= 2 &&
                             runs_.back().step == step && runs_.back().at(size_) == first;
        if (goes_on) {
            grow(count);
            return;
        }
        push_back(first);
    }
}

const IdRuns::Run& IdRuns::run_of(std::size_t at) const {
    const std::size_t b = at / block;
    const std::size_t last = b + 1 < run_at_block_.size() ? run_at_block_[b + 1] : runs_.size() - 1;
    const auto after = [this](std::size_t run) {
        return runs_.begin() + static_cast<std::ptrdiff_t>(run + 1);
    };
    const auto next = std::upper_bound(after(run_at_block_[b]), after(last), at,
                                       [](std::size_t place, const Run& run) { return place < run.begin; });
    return *std::prev(next);
}

std::int64_t IdRuns::operator[](std::size_t at) const {
    return plain_.empty() ? run_of(at).at(at) : plain_[at];
}

void IdRuns::copy(std::size_t begin, std::size_t end, std::int64_t* out) const {
    if (!plain_.empty()) {
        std::copy(plain_.begin() + static_cast<std::ptrdiff_t>(begin),
                  plain_.begin() + static_cast<std::ptrdiff_t>(end), out);
        return;
    }
    const Run* run = begin < end ? &run_of(begin) : nullptr;
    while (begin < end) {
        const bool is_last = run == &runs_.back();
        const std::size_t stop = is_last ? end : std::min(end, run[1].begin);
        for (; begin < stop; ++begin) {
            *out++ = run->at(begin);
        }
        run += is_last ? 0 : 1;
    }
}

bool IdRuns::ascending() const {
    if (!plain_.empty()) {
        return std::adjacent_find(plain_.begin(), plain_.end(), std::greater_equal<>{}) == plain_.end();
    }
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].begin : size_;
        if ((end - runs_[r].begin > 1 && runs_[r].step == 0) ||
            (end < size_ && runs_[r].at(end - 1) >= runs_[r + 1].first)) {
            return false;
        }
    }
    return true;
}

bool operator==(const IdRuns& a, const IdRuns& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

} // namespace slabhull
