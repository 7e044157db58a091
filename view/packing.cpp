// SPDX-License-Identifier: BSD-3-Clause
#include "view/packing.h"

#include <algorithm>
#include <array>

namespace slabhull {

namespace {

constexpr std::size_t remembered = 15;

/// The vertices last met, in a ring.
class RecentVertices {
public:
    /// How many have been added after this one; `remembered` where it is not among the last.
    std::size_t age(Index vertex) const {
        for (std::size_t age = 0; age < remembered; ++age) {
            if (ring_[(next_ + remembered - 1 - age) % remembered] == vertex) {
                return age;
            }
        }
        return remembered;
    }
    void add(Index vertex) {
        ring_[next_] = vertex;
        next_ = (next_ + 1) % remembered;
    }
    RecentVertices() { ring_.fill(no_index); }

private:
    std::array<Index, remembered> ring_;
    std::size_t next_ = 0;
};

} // namespace

void append_number(Packed& packed, std::uint64_t number) {
    for (; number > 127; number >>= 7) {
        packed.push_back(static_cast<std::uint8_t>(number & 127) | 128);
    }
    packed.push_back(static_cast<std::uint8_t>(number));
}

void append_difference(Packed& packed, std::int64_t d) {
    append_number(packed,
                  d < 0 ? 2 * static_cast<std::uint64_t>(-(d + 1)) + 1 : 2 * static_cast<std::uint64_t>(d));
}

Packed pack_differences(std::span<const std::int64_t> values) {
    Packed packed;
    std::int64_t before = 0;
    for (const std::int64_t value : values) {
        append_difference(packed, value - before);
        before = value;
    }
    return packed;
}

Packed pack_runs(std::span<const std::int64_t> values) {
    Packed packed;
    for (auto run = values.begin(); run != values.end();) {
        const auto end = std::find_if(run, values.end(), [run](std::int64_t value) { return value != *run; });
        append_number(packed, static_cast<std::uint64_t>(*run));
        append_number(packed, static_cast<std::uint64_t>(end - run));
        run = end;
    }
    return packed;
}

PackedCells pack_cells(std::span<const Index> vertices) {
    PackedCells packed;
    RecentVertices recent;
    Index end = 0; // of the vertices so far
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const std::size_t code = recent.age(vertices[k]);
        if (code == remembered) {
            append_difference(packed.far, std::int64_t{end} - vertices[k]);
            end = std::max(end, vertices[k] + 1);
            recent.add(vertices[k]);
        }
        k % 2 == 0 ? packed.codes.push_back(static_cast<std::uint8_t>(code))
                   : void(packed.codes.back() |= static_cast<std::uint8_t>(code << 4));
    }
    return packed;
}

} // namespace slabhull
