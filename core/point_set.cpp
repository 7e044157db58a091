// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/point_set.h"

#include <algorithm>
#include <bit>

namespace slabhull {

namespace {
std::size_t ones(std::uint64_t word) {
    return static_cast<std::size_t>(std::popcount(word));
}
} // namespace

void PointSet::insert(const PointSet& other) {
    std::transform(words_.begin(), words_.end(), other.words_.begin(), words_.begin(),
                   [](std::uint64_t a, std::uint64_t b) { return a | b; });
}

void PointSet::insert_complement(const PointSet& other) {
    std::transform(words_.begin(), words_.end(), other.words_.begin(), words_.begin(),
                   [](std::uint64_t a, std::uint64_t b) { return a | ~b; });
    std::fill(words_.begin() + static_cast<std::ptrdiff_t>(points_ / word_bits) + 1, words_.end(), 0);
    words_[points_ / word_bits] &= (std::uint64_t{1} << points_ % word_bits) - 1;
}

void PointSet::count() {
    before_.clear();
    size_ = 0;
    for (std::size_t word = 0; word < words_.size(); ++word) {
        if (word % block_words == 0) {
            before_.push_back(size_);
        }
        size_ += ones(words_[word]);
    }
}

std::size_t PointSet::rank(std::size_t point) const {
    const std::size_t last = point / word_bits;
    std::size_t result = before_[last / block_words];
    for (std::size_t word = last - last % block_words; word < last; ++word) {
        result += ones(words_[word]);
    }
    return result + ones(words_[last] & ((std::uint64_t{1} << point % word_bits) - 1));
}

std::size_t PointSet::member(std::size_t rank) const {
    const auto block = std::upper_bound(before_.begin(), before_.end(), rank) - before_.begin() - 1;
    std::size_t left = rank - before_[static_cast<std::size_t>(block)];
    std::size_t word = static_cast<std::size_t>(block) * block_words;
    for (; left >= ones(words_[word]); ++word) {
        left -= ones(words_[word]);
    }
    std::uint64_t bits = words_[word];
    for (; left > 0; --left) {
        bits &= bits - 1;
    }
    return word * word_bits + static_cast<std::size_t>(std::countr_zero(bits));
}

std::size_t PointSet::next(std::size_t member) const {
    std::size_t word = member / word_bits;
    std::uint64_t bits = words_[word] & (~std::uint64_t{1} << member % word_bits);
    while (bits == 0) {
        bits = words_[++word];
    }
    return word * word_bits + static_cast<std::size_t>(std::countr_zero(bits));
}

} // namespace slabhull
