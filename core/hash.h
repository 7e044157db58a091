// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace slabhull {

/// Knuth's multiplicative hashing: the upper bits of the product are well mixed (The Art of Computer
/// Programming 3, 6.4).
constexpr std::uint64_t multiplied_hash(std::uint64_t key) {
    return key * 0x9E3779B97F4A7C15u; // 2^64 over the golden ratio
}

/// A slot of a table of 2^bits slots.
constexpr std::uint64_t hash_slot(std::uint64_t key, int bits) {
    return multiplied_hash(key) >> (64 - bits);
}

/// Takes one more value into the hash of several, all of whose bits are mixed.
constexpr std::uint64_t combined_hash(std::uint64_t hash, std::uint64_t value) {
    const std::uint64_t product = multiplied_hash(hash ^ value);
    return product ^ product >> 32;
}

/// The hash of several integers in their order, after what `before` is the hash of.
template<class Integers>
constexpr std::uint64_t hash_of_all(const Integers& values, std::uint64_t before = 0) {
    for (const auto value : values) {
        before = combined_hash(before, static_cast<std::uint64_t>(value));
    }
    return before;
}

} // namespace slabhull
