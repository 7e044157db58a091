// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/integer_list.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

namespace slabhull {

namespace {

/// Runs are given up when there are many, and shorter than this on average: they would save little, and cost
/// time.
constexpr std::size_t worth_a_run = 16;
constexpr std::size_t many_runs = 64;

} // namespace

IntegerList::IntegerList(Array<std::int64_t> values) {
    const bool fits = std::all_of(values.begin(), values.end(),
                                  [](std::int64_t value) { return std::in_range<std::int32_t>(value); });
    if (fits) {
        Array<std::int32_t> small(values.size());
        std::transform(values.begin(), values.end(), small.begin(),
                       [](std::int64_t value) { return static_cast<std::int32_t>(value); });
        values = {};
        take(std::move(small), narrow_);
    } else {
        take(std::move(values), wide_);
    }
}

IntegerList::IntegerList(Array<std::int32_t> values) {
    take(std::move(values), narrow_);
}

template<class T>
void IntegerList::take(Array<T>&& values, Array<T>& own) {
    const auto rises_by = [](T from, T to, std::uint64_t step) {
        return to >= from && static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from) == step;
    };
    for (std::size_t begin = 0, end = 0; begin < values.size() && in_runs(); begin = end) {
        end = begin + 1;
        const bool ascends = end < values.size() && rises_by(values[begin], values[end], 1);
        while (end < values.size() && rises_by(values[end - 1], values[end], ascends ? 1 : 0)) {
            ++end;
        }
        append_run(values[begin], end - begin, ascends ? 1 : 0);
    }
    if (!in_runs()) {
        narrow_ = {};
        wide_ = {};
        own = std::move(values);
        size_ = own.size();
    }
}

void IntegerList::push_back(std::int64_t value) {
    if (!narrow_.empty() && !std::in_range<std::int32_t>(value)) {
        widen();
    }
    if (!narrow_.empty()) {
        narrow_.push_back(static_cast<std::int32_t>(value));
    } else if (!wide_.empty()) {
        wide_.push_back(value);
    } else if (!extends_last_run(value)) {
        runs_.push_back({size_, value, 0});
        if (runs_.size() > many_runs && runs_.size() * worth_a_run > size_) {
            ++size_;
            give_up_runs();
            return;
        }
    }
    grow(1);
}

void IntegerList::grow(std::size_t count) {
    size_ += count;
    while (run_at_block_.size() * block < size_ && in_runs()) {
        run_at_block_.push_back(runs_.size() - 1);
    }
}

bool IntegerList::extends_last_run(std::int64_t value) {
    if (runs_.empty()) {
        return false;
    }
    Run& last = runs_.back();
    if (size_ - last.begin == 1) {
        last.step = value > last.first ? 1 : 0;
    }
    return value == last.at(size_) && value >= last.first; // at() wraps around behind the largest
}

void IntegerList::give_up_runs() {
    const auto fits = [](const Run& run, std::size_t end) {
        return std::in_range<std::int32_t>(run.first) && std::in_range<std::int32_t>(run.at(end - 1));
    };
    bool all_fit = true;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        all_fit = all_fit && fits(runs_[r], r + 1 < runs_.size() ? runs_[r + 1].begin : size_);
    }
    Array<std::int64_t> all(size_);
    copy(0, size_, all.data());
    runs_ = {};
    run_at_block_ = {};
    if (all_fit) {
        narrow_.assign(all.begin(), all.end());
    } else {
        wide_ = std::move(all);
    }
}

void IntegerList::widen() {
    wide_.assign(narrow_.begin(), narrow_.end());
    narrow_ = {};
}

void IntegerList::append(std::span<const std::int64_t> values) {
    for (const std::int64_t value : values) {
        push_back(value);
    }
}

void IntegerList::append_list(const IntegerList& more) {
    if (!narrow_.empty() && !more.narrow_.empty()) {
        narrow_.insert(narrow_.end(), more.narrow_.begin(), more.narrow_.end());
        size_ = narrow_.size();
        return;
    }
    for (const std::int64_t value : more) {
        push_back(value);
    }
}

void IntegerList::append_run(std::int64_t first, std::size_t count, std::int64_t step) {
    for (; count > 0; --count, first += count > 0 ? step : 0) {
        const bool goes_on = in_runs() && !runs_.empty() && size_ - runs_.back().begin >= 2 &&
                             runs_.back().step == step && runs_.back().at(size_) == first;
        if (goes_on) {
            grow(count);
            return;
        }
        push_back(first);
    }
}

const IntegerList::Run& IntegerList::search_run(const Run* first, const Run* last, std::size_t at) {
    const Run* const next = std::upper_bound(
        first + 1, last + 1, at, [](std::size_t place, const Run& run) { return place < run.begin; });
    return next[-1];
}

std::int64_t IntegerList::at(std::size_t place) const {
    if (place >= size_) {
        throw std::out_of_range{"IntegerList::at"};
    }
    return (*this)[place];
}

void IntegerList::copy(std::size_t begin, std::size_t end, std::int64_t* out) const {
    if (!narrow_.empty()) {
        std::copy(narrow_.data() + begin, narrow_.data() + end, out);
        return;
    }
    if (!wide_.empty()) {
        std::copy(wide_.data() + begin, wide_.data() + end, out);
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

bool IntegerList::ascending() const {
    if (!in_runs()) {
        return std::adjacent_find(begin(), end(), std::greater_equal<>{}) == end();
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

bool operator==(const IntegerList& a, const IntegerList& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

Column<std::int64_t> integer_column(const IntegerList& list, int components, std::size_t first) {
    const auto width = static_cast<std::size_t>(components);
    return {list.size() / width - first, components,
            [&list, width, first](std::size_t begin, std::size_t end, std::int64_t* out) {
                list.copy((first + begin) * width, (first + end) * width, out);
            }};
}

} // namespace slabhull
