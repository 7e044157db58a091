// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

namespace slabhull {

/// Two lists read as one: what a rank has of a mesh, and what others have sent it, without a copy of both.
template<class T>
class JoinedSpans {
public:
    template<class List>
    JoinedSpans(const List& first) : first_{first} {}
    JoinedSpans(std::span<const T> first, std::span<const T> second) : first_{first}, second_{second} {}

    std::size_t size() const { return first_.size() + second_.size(); }
    const T& operator[](std::size_t k) const {
        return k < first_.size() ? first_[k] : second_[k - first_.size()];
    }

private:
    std::span<const T> first_;
    std::span<const T> second_;
};

} // namespace slabhull
