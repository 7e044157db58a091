// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace slabhull {

/// Local index of a vertex, facet or cell inside one mesh. 32 bits: a mesh holds fewer than 2^32 - 1 of each.
using Index = std::uint32_t;
inline constexpr Index no_index = std::numeric_limits<Index>::max();

/// Persistent id of a space-time point: given once, never reused. 64 bits because a march never stops
/// counting.
using PersistentId = std::int64_t;
/// Track of a boundary vertex through time; `no_track` for points off the tracks.
using TrackId = std::int64_t;
inline constexpr TrackId no_track = -1;

/// An index that says what it indexes: a FacetId where a VertexId is wanted does not compile.
template<class Kind>
class Id {
public:
    constexpr Id() = default;
    constexpr explicit Id(Index slot) : slot_{slot} {}
    constexpr bool valid() const { return slot_ != no_index; }
    constexpr Index slot() const { return slot_; }
    friend constexpr auto operator<=>(Id, Id) = default;

private:
    Index slot_ = no_index;
};

using VertexId = Id<struct VertexKind>;
using FacetId = Id<struct FacetKind>;
using CellId = Id<struct CellKind>;

/// `count` as a local index. Throws LimitError when it does not fit; `what` names the things counted.
Index checked_index(std::size_t count, const char* what);

} // namespace slabhull
