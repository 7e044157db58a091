// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace slabhull {

/// Numbers in ascending order, each once, whose places are found faster than by bisection: numbers with the
/// same leading bits are looked through. Cost of that: 4 to 8 bytes for each.
class AscendingNumbers {
public:
    explicit AscendingNumbers(Array<std::uint64_t> numbers) : numbers_{std::move(numbers)} {
        checked_index(numbers_.size(), "numbers in a list");
        if (numbers_.empty()) {
            return;
        }
        while (range() >> shift_ >= 2 * numbers_.size()) {
            ++shift_;
        }
        begin_.assign((range() >> shift_) + 2, 0);
        for (std::size_t k = 0, bucket = 0; k < numbers_.size(); ++k) {
            while (bucket <= bucket_of(numbers_[k])) {
                begin_[bucket++] = static_cast<Index>(k);
            }
        }
        begin_.back() = static_cast<Index>(numbers_.size());
    }

    std::size_t size() const { return numbers_.size(); }
    std::uint64_t operator[](std::size_t place) const { return numbers_[place]; }

    /// no_index for a number that is not here.
    Index place(std::uint64_t number) const {
        if (numbers_.empty() || number < numbers_.front() || number > numbers_.back()) {
            return no_index;
        }
        const std::size_t bucket = bucket_of(number);
        const auto end = numbers_.begin() + begin_[bucket + 1];
        const auto found = std::lower_bound(numbers_.begin() + begin_[bucket], end, number);
        return found != end && *found == number ? static_cast<Index>(found - numbers_.begin()) : no_index;
    }

private:
    std::uint64_t range() const { return numbers_.back() - numbers_.front(); }
    std::size_t bucket_of(std::uint64_t number) const { return (number - numbers_.front()) >> shift_; }

    Array<std::uint64_t> numbers_;
    int shift_ = 0;
    Array<Index> begin_; ///< of each bucket; one more entry
};

} // namespace slabhull
