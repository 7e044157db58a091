// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <cstdint>

namespace slabhull {

/// A part of a hull with one layer of ghosts: the cells of other parts at vertices that this rank owns. The
/// owner of a vertex is the lowest rank that uses it.
template<int D>
struct PartStars {
    /// The part's cells, then ghosts, ascending by their numbers in the hull. Their vertices are the part's,
    /// then those of ghosts alone.
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors; ///< among these cells; no_index for others
    Array<std::uint8_t> region;    ///< of these cells
    Array<std::uint8_t> owned;     ///< of each vertex: whether this rank owns it
};

/// Completes the stars of the vertices that each rank owns. `region` are those of the part's cells.
/// Collective. Cost: linear; what is sent grows with the boundaries between parts, but for 8 bytes of each
/// point.
template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const Array<std::uint8_t>& region, Communicator& ranks);

/// Which rank a point of the hull is asked for, where something is to be known of all its uses.
inline std::size_t home_of_point(std::size_t point, std::size_t points, std::size_t ranks) {
    return std::min(ranks - 1, point / (points / ranks + 1)); // consecutive points have one home
}

/// Calls visit(k, number) for each point k of a part, with its number in the hull.
template<int D, class Visit>
void each_point_of(const HullPart<D>& part, const Visit& visit) {
    std::size_t number = part.points.empty() ? 0 : part.points_used->member(0);
    for (std::size_t k = 0; k < part.points.size(); ++k) {
        visit(k, number);
        number = k + 1 < part.points.size() ? part.points_used->next(number) : number;
    }
}

/// A value of each cell of HullPart::outside, from the rank that has it; `value_of` gives it for a cell of
/// the part. Collective.
template<class T, int D, class ValueOf>
Array<T> values_outside(const HullPart<D>& part, Communicator& ranks, const ValueOf& value_of) {
    const std::vector<std::size_t> first = ranks.gather(part.range.first);
    std::vector<Array<std::uint64_t>> wanted(first.size());
    for (const std::uint64_t number : part.outside) {
        const auto after = std::upper_bound(first.begin(), first.end(), number);
        wanted[static_cast<std::size_t>(after - first.begin()) - 1].push_back(number);
    }
    std::vector<Array<T>> answers(first.size());
    const std::vector<Array<std::uint64_t>> asked = ranks.all_to_all(wanted);
    for (std::size_t r = 0; r < asked.size(); ++r) {
        for (const std::uint64_t number : asked[r]) {
            answers[r].push_back(value_of(static_cast<Index>(number - part.range.first)));
        }
    }
    Array<T> values;
    for (const Array<T>& told : ranks.all_to_all(answers)) {
        values.insert(values.end(), told.begin(), told.end());
    }
    return values;
}

} // namespace slabhull
