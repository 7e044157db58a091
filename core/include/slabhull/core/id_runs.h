// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// A list of persistent ids or tracks. They mostly come in runs, of consecutive ids or of no_track: a run
/// costs 24 bytes, whatever its length. A list that has no such order is stored as it is, 8 bytes each.
/// Reading is as from a vector; a list only grows at its end.
class IdRuns {
public:
    using value_type = std::int64_t;

    class Iterator {
    public:
        using iterator_category = std::random_access_iterator_tag;
        using value_type = std::int64_t;
        using difference_type = std::ptrdiff_t;
        using pointer = void;
        using reference = std::int64_t;

        Iterator() = default;
        Iterator(const IdRuns* list, std::size_t at) : list_{list}, at_{static_cast<std::ptrdiff_t>(at)} {}
        reference operator*() const { return (*list_)[static_cast<std::size_t>(at_)]; }
        reference operator[](difference_type step) const { return *(*this + step); }
        Iterator& operator++() { return *this += 1; }
        Iterator& operator--() { return *this += -1; }
        Iterator operator++(int) { return std::exchange(*this, *this + 1); }
        Iterator operator--(int) { return std::exchange(*this, *this - 1); }
        Iterator& operator+=(difference_type step) {
            at_ += step;
            return *this;
        }
        Iterator& operator-=(difference_type step) { return *this += -step; }
        friend Iterator operator+(Iterator at, difference_type step) { return at += step; }
        friend Iterator operator+(difference_type step, Iterator at) { return at += step; }
        friend Iterator operator-(Iterator at, difference_type step) { return at += -step; }
        friend difference_type operator-(const Iterator& a, const Iterator& b) { return a.at_ - b.at_; }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }
        friend auto operator<=>(const Iterator& a, const Iterator& b) { return a.at_ <=> b.at_; }

    private:
        const IdRuns* list_ = nullptr;
        std::ptrdiff_t at_ = 0;
    };

    IdRuns() = default;
    IdRuns(std::initializer_list<std::int64_t> ids) { append({ids.begin(), ids.size()}); }

    void push_back(std::int64_t id);
    void append(std::span<const std::int64_t> ids);
    /// first, first + step, ...; `step` is 0 or 1.
    void append_run(std::int64_t first, std::size_t count, std::int64_t step);

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// Cost: logarithmic in the number of runs that are near.
    std::int64_t operator[](std::size_t at) const;
    std::int64_t back() const { return (*this)[size_ - 1]; }
    Iterator begin() const { return {this, 0}; }
    Iterator end() const { return {this, size_}; }
    /// Writes the ids at [begin, end) to `out`.
    void copy(std::size_t begin, std::size_t end, std::int64_t* out) const;
    /// Whether each id is larger than the one before.
    bool ascending() const;

    friend bool operator==(const IdRuns& a, const IdRuns& b);

private:
    struct Run {
        std::size_t begin;
        std::int64_t first;
        std::int64_t step; ///< 0 or 1; counts only where a run has two ids
        std::int64_t at(std::size_t place) const {
            return first + step * static_cast<std::int64_t>(place - begin);
        }
    };

    /// The run that holds the id at a place.
    const Run& run_of(std::size_t at) const;
    bool extends_last_run(std::int64_t id);
    void give_up_runs();
    void grow(std::size_t count);

    static constexpr std::size_t block = 1 << 12;

    std::vector<Run> runs_;
    std::vector<std::size_t>
        run_at_block_; ///< for each block of ids, the run that holds its first id; a search starts there
    Array<std::int64_t> plain_; ///< the ids themselves, where runs would be too many
    std::size_t size_ = 0;
};

} // namespace slabhull
