// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <compare>
#include <cstddef>
#include <iterator>

namespace slabhull {

/// The ids 0 .. count - 1 of one kind, which are made from numbers, as a random-access range. (Clang 14,
/// which the fuzzers need, does not compile a view of libstdc++ 12 in its place.)
template<class IdType, class Number = Index>
class IdRange {
public:
    class Iterator {
    public:
        using iterator_category = std::random_access_iterator_tag;
        using value_type = IdType;
        using difference_type = std::ptrdiff_t;
        using pointer = void;
        using reference = IdType;

        Iterator() = default;
        explicit Iterator(Number number) : number_{number} {}
        reference operator*() const { return IdType{number_}; }
        reference operator[](difference_type step) const { return *(*this + step); }
        Iterator& operator++() { return *this += 1; }
        Iterator& operator--() { return *this += -1; }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        Iterator operator--(int) {
            const Iterator before = *this;
            --*this;
            return before;
        }
        Iterator& operator+=(difference_type step) {
            number_ += static_cast<Number>(step);
            return *this;
        }
        Iterator& operator-=(difference_type step) { return *this += -step; }
        friend Iterator operator+(Iterator at, difference_type step) { return at += step; }
        friend Iterator operator+(difference_type step, Iterator at) { return at += step; }
        friend Iterator operator-(Iterator at, difference_type step) { return at -= step; }
        friend difference_type operator-(const Iterator& a, const Iterator& b) {
            return static_cast<difference_type>(a.number_) - static_cast<difference_type>(b.number_);
        }
        friend auto operator<=>(const Iterator&, const Iterator&) = default;

    private:
        Number number_ = 0;
    };

    explicit IdRange(std::size_t count) : count_{count} {}
    Iterator begin() const { return Iterator{0}; }
    Iterator end() const { return Iterator{static_cast<Number>(count_)}; }
    std::size_t size() const { return count_; }
    bool empty() const { return count_ == 0; }
    IdType operator[](std::size_t k) const { return begin()[static_cast<std::ptrdiff_t>(k)]; }

private:
    std::size_t count_;
};

template<class IdType>
IdRange<IdType> id_range(std::size_t count) {
    return IdRange<IdType>{count};
}

} // namespace slabhull
