// SPDX-License-Identifier: BSD-3-Clause
// What ranks that hold parts of a hull ask each other.
#pragma once

#include "core/pieces.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace slabhull {

/// Calls visit(k, number) for each point k of a part, with its number in the hull.
template<int D, class Visit>
void each_point_of(const HullPart<D>& part, const Visit& visit) {
    std::size_t number = part.points.empty() ? 0 : part.points_used->member(0);
    for (std::size_t k = 0; k < part.points.size(); ++k) {
        visit(k, number);
        number = k + 1 < part.points.size() ? part.points_used->next(number) : number;
    }
}

/// Answers what each rank has asked, `asked`, with value_of(question); returns the answers to this rank's own
/// questions, those to the first rank first. Collective.
template<class T, class Question, class ValueOf>
Array<T> answered(Communicator& ranks, const std::vector<Array<Question>>& asked, const ValueOf& value_of) {
    std::vector<Array<T>> answers(asked.size());
    for (std::size_t r = 0; r < asked.size(); ++r) {
        for (const Question& question : asked[r]) {
            answers[r].push_back(value_of(question));
        }
    }
    return joined(ranks.all_to_all(answers));
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
    return answered<T>(ranks, ranks.all_to_all(wanted), [&](std::uint64_t number) {
        return value_of(static_cast<Index>(number - part.range.first));
    });
}

/// For each point of a part, the lowest of the values that it has in the parts which use it; `mine` are those
/// in this one. Each point has a home, which is told by all who use it, and answers. Collective.
template<class T, int D>
Array<T> lowest_at_points(const HullPart<D>& part, Communicator& ranks, const Array<T>& mine) {
    struct Use {
        std::uint64_t point;
        T value;
    };
    const auto count = static_cast<std::size_t>(ranks.size());
    const std::size_t at_home = part.hull_points() / count + 1; // consecutive points have one home
    std::vector<Array<Use>> uses(count);
    each_point_of(part, [&](std::size_t k, std::size_t number) {
        uses[number / at_home].push_back({number, mine[k]});
    });
    const std::vector<Array<Use>> asked = ranks.all_to_all(uses);
    const std::size_t begin = static_cast<std::size_t>(ranks.rank()) * at_home;
    Array<T> lowest(at_home, std::numeric_limits<T>::max());
    for (const Array<Use>& of_rank : asked) {
        for (const Use& use : of_rank) {
            lowest[use.point - begin] = std::min(lowest[use.point - begin], use.value);
        }
    }
    return answered<T>(ranks, asked, [&](const Use& use) { return lowest[use.point - begin]; });
}

} // namespace slabhull
