// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Some of the points of a mesh (or of its cells), numbered in ascending order: a bit per point and a count
/// per 512. Reading is safe from several threads.
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
    /// Rounded up to whole blocks, so that block ends need no check.
    static std::size_t words_for(std::size_t points) {
        return (points / (word_bits * block_words) + 1) * block_words;
    }

    std::size_t points_;
    std::vector<std::uint64_t> words_;
    std::vector<std::uint64_t> before_; ///< number of members before each block
    std::size_t size_ = 0;
};

} // namespace slabhull
