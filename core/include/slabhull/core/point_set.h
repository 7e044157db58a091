// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Some of the points of a mesh (or of its cells), numbered in ascending order: a bit per point, and counts
/// of 16 bytes per 512. Reading is safe from several threads. Source: Vigna, "Broadword
/// implementation of rank/select queries", WEA 2008 (rank9).
class PointSet {
public:
    explicit PointSet(std::size_t points) : points_{points}, words_(words_for(points)) {}

    /// How many points the mesh has.
    std::size_t all() const { return points_; }
    bool contains(std::size_t point) const {
        return (words_[point / word_bits] >> point % word_bits & 1) != 0;
    }
    /// The bits of points 0 to 63, then of 64 to 127 and so on; those of no point are 0.
    std::span<const std::uint64_t> words() const { return words_; }
    void insert(std::size_t point) { words_[point / word_bits] |= std::uint64_t{1} << point % word_bits; }
    /// Inserts all points that the other set does not contain.
    void insert_complement(const PointSet& other);
    void insert(const PointSet& other);
    /// Call after the last insertion and before the functions below.
    void count();

    std::size_t size() const { return size_; }
    /// The number of a member: how many are smaller. The end of all points is also allowed.
    std::size_t rank(std::size_t point) const;
    /// The member with a number, which must be below size().
    std::size_t member(std::size_t rank) const;
    /// The next member after a given one.
    std::size_t next(std::size_t member) const;

private:
    static constexpr std::size_t word_bits = 64;
    static constexpr std::size_t block_words = 8;
    static constexpr std::size_t count_bits = 9;
    /// Rounded up to whole blocks, so that block ends need no check.
    static std::size_t words_for(std::size_t points) {
        return (points / (word_bits * block_words) + 1) * block_words;
    }

    std::size_t points_;
    std::vector<std::uint64_t> words_;
    /// Of the members: how many there are before a block of words, and within it before each of its words but
    /// the first, in 9 bits each.
    struct Counts {
        std::size_t before = 0;
        std::uint64_t within = 0;
        /// Before a word of the block.
        std::size_t at(std::size_t word) const {
            return before + (word == 0 ? 0 : within >> count_bits * (word - 1) & ((1U << count_bits) - 1));
        }
    };
    std::vector<Counts> counts_;
    std::size_t size_ = 0;
};

} // namespace slabhull
