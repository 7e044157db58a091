// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/column.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// A list of integers in little memory. Persistent ids, tracks, regions and the like mostly come in runs, of
/// consecutive integers or of equal ones: a run costs 24 bytes, whatever its length. A list that has no such
/// order costs 4 bytes an integer while all of them fit, else 8. Reading is as from a vector; a list only
/// grows at its end.
class IntegerList {
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
        Iterator(const IntegerList* list, std::size_t at)
            : list_{list}, at_{static_cast<std::ptrdiff_t>(at)} {}
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
        const IntegerList* list_ = nullptr;
        std::ptrdiff_t at_ = 0;
    };

    IntegerList() = default;
    IntegerList(std::initializer_list<std::int64_t> values) { append({values.begin(), values.size()}); }
    /// Those of an array, which is kept when nothing smaller will do.
    IntegerList(Array<std::int64_t> values);
    IntegerList(Array<std::int32_t> values);
    /// value(0), value(1) ... value(count - 1), asked for in this order.
    template<class Value>
    static IntegerList generated(std::size_t count, const Value& value);

    void push_back(std::int64_t value);
    void append(std::span<const std::int64_t> values);
    void append_list(const IntegerList& more);
    /// first, first + step, ...; `step` is 0 or 1.
    void append_run(std::int64_t first, std::size_t count, std::int64_t step);

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// Cost: logarithmic in the number of runs that are near.
    std::int64_t operator[](std::size_t at) const {
        return !narrow_.empty() ? narrow_[at] : !wide_.empty() ? wide_[at] : run_of(at).at(at);
    }
    std::int64_t at(std::size_t place) const;
    std::int64_t back() const { return (*this)[size_ - 1]; }
    Iterator begin() const { return {this, 0}; }
    Iterator end() const { return {this, size_}; }
    /// Writes the integers at [begin, end) to `out`.
    void copy(std::size_t begin, std::size_t end, std::int64_t* out) const;
    /// Whether each is larger than the one before.
    bool ascending() const;
    /// All, where they are stored in 4 bytes each; else nothing.
    std::span<const std::int32_t> narrow() const { return narrow_; }

    friend bool operator==(const IntegerList& a, const IntegerList& b);

private:
    struct Run {
        std::size_t begin;
        std::int64_t first;
        std::int64_t step; ///< 0 or 1; counts only where a run has two ids
        std::int64_t at(std::size_t place) const {
            return static_cast<std::int64_t>(static_cast<std::uint64_t>(first) +
                                             static_cast<std::uint64_t>(step) * (place - begin));
        }
    };

    /// The run that holds the integer at a place. Most blocks have one run only, or the start of a second.
    const Run& run_of(std::size_t at) const {
        const std::size_t b = at / block;
        const Run* const first = runs_.data() + run_at_block_[b];
        const Run* const last =
            runs_.data() + (b + 1 < run_at_block_.size() ? run_at_block_[b + 1] : runs_.size() - 1);
        if (last - first > 1) {
            return search_run(first, last, at);
        }
        return at < last->begin ? *first : *last;
    }
    static const Run& search_run(const Run* first, const Run* last, std::size_t at);
    bool in_runs() const { return narrow_.empty() && wide_.empty(); }
    bool extends_last_run(std::int64_t value);
    void give_up_runs();
    void widen();
    void grow(std::size_t count);
    template<class T>
    void take(Array<T>&& values, Array<T>& own);

    static constexpr std::size_t block = 1 << 12;

    std::vector<Run> runs_;
    std::vector<std::size_t>
        run_at_block_; ///< for each block of integers, the run that holds its first; a search starts there
    Array<std::int32_t> narrow_; ///< the integers themselves, where runs would be too many
    Array<std::int64_t> wide_;   ///< the same, where some need more than 32 bits
    std::size_t size_ = 0;
};

template<class Value>
IntegerList IntegerList::generated(std::size_t count, const Value& value) {
    Array<std::int32_t> narrow(count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::int64_t next = value(k);
        if (!std::in_range<std::int32_t>(next)) {
            Array<std::int64_t> wide(count);
            std::copy_n(narrow.begin(), k, wide.begin());
            wide[k] = next;
            while (++k < count) {
                wide[k] = value(k);
            }
            return wide;
        }
        narrow[k] = static_cast<std::int32_t>(next);
    }
    return narrow;
}

/// Rows of `components` integers, those from row `first` on. The list must outlive the column.
Column<std::int64_t> integer_column(const IntegerList& list, int components = 1, std::size_t first = 0);

} // namespace slabhull
