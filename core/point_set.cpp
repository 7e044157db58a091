// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/point_set.h"

#include <algorithm>
#include <bit>

namespace slabhull {

namespace {

/// std::popcount() calls a library where a processor need not have the instruction, and takes three times as
/// long.
std::size_t ones(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555;
    word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return word * 0x0101010101010101 >> 56;
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
    counts_.assign(words_.size() / block_words, {});
    size_ = 0;
    for (std::size_t block = 0; block < counts_.size(); ++block) {
        Counts& counts = counts_[block];
        counts.before = size_;
        for (std::size_t word = 0; word < block_words; ++word) {
            if (word > 0) {
                counts.within |= static_cast<std::uint64_t>(size_ - counts.before) << count_bits * (word - 1);
            }
            size_ += ones(words_[block * block_words + word]);
        }
    }
}

std::size_t PointSet::rank(std::size_t point) const {
    const std::size_t word = point / word_bits;
    return counts_[word / block_words].at(word % block_words) +
           ones(words_[word] & ((std::uint64_t{1} << point % word_bits) - 1));
}

std::size_t PointSet::member(std::size_t rank) const {
    const auto found =
        std::upper_bound(counts_.begin(), counts_.end(), rank,
                         [](std::size_t r, const Counts& counts) { return r < counts.before; });
    const auto block = static_cast<std::size_t>(found - counts_.begin()) - 1;
    std::size_t place = block_words - 1;
    while (counts_[block].at(place) > rank) {
        --place;
    }
    const std::size_t word = block * block_words + place;
    std::uint64_t bits = words_[word];
    for (std::size_t left = rank - counts_[block].at(place); left > 0; --left) {
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
