// SPDX-License-Identifier: BSD-3-Clause
// What ranks that hold parts of a hull ask each other.
#pragma once

#include "core/each_bit.h"
#include "core/pieces.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/point_set.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

/// Which of the hull's points in a range of 64 or a multiple are in a set, one bit each.
inline std::span<const std::uint64_t> words_of_points(const PointSet& points, std::size_t first,
                                                      std::size_t count) {
    const std::span<const std::uint64_t> all = points.words();
    const std::size_t begin = std::min(first / 64, all.size());
    return all.subspan(begin, std::min(count / 64, all.size() - begin));
}

/// Calls visit(k, point) for the points whose bits are set, the k-th of them.
template<class Visit>
void each_point_in(std::span<const std::uint64_t> words, const Visit& visit) {
    std::size_t k = 0;
    for (std::size_t w = 0; w < words.size(); ++w) {
        each_bit(words[w], [&](std::size_t bit) { visit(k++, 64 * w + bit); });
    }
}

/// For each point of a part, the lowest of the values that it has in the parts which use it; `mine` are those
/// in this one. Each point has a home, which is told by all who use it, and answers. Collective.
template<class T, int D>
Array<T> lowest_at_points(const HullPart<D>& part, Communicator& ranks, std::span<const T> mine) {
    const auto count = static_cast<std::size_t>(ranks.size());
    const std::size_t at_home = (part.hull_points() / count / 64 + 1) * 64; // consecutive points
    std::vector<std::span<const std::uint64_t>> used(count);
    std::vector<std::span<const T>> values(count);
    for (std::size_t home = 0, begin = 0; home < count; ++home) {
        used[home] = words_of_points(*part.points_used, home * at_home, at_home);
        const std::size_t next = std::min((home + 1) * at_home, part.hull_points());
        const std::size_t end = part.points_used->rank(next);
        values[home] = mine.subspan(begin, end - begin);
        begin = end;
    }
    const std::vector<Array<std::uint64_t>> used_by = ranks.all_to_all(used);
    std::vector<Array<T>> told = ranks.all_to_all(values);
    Array<T> lowest;
    lowest.assign(at_home, std::numeric_limits<T>::max());
    for (std::size_t r = 0; r < count; ++r) {
        each_point_in(used_by[r], [&](std::size_t k, std::size_t point) {
            lowest[point] = std::min(lowest[point], told[r][k]);
        });
    }
    for (std::size_t r = 0; r < count; ++r) { // the answers take the place of what was told
        each_point_in(used_by[r], [&](std::size_t k, std::size_t point) { told[r][k] = lowest[point]; });
    }
    return joined(ranks.all_to_all(told));
}

} // namespace slabhull
