// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace slabhull {

/// parallel_for() with a result per piece: body(begin, end, piece) fills the `piece` of [begin, end), which
/// starts as a copy of `initial`. The results come back in the order of the pieces.
template<class Piece, class Body>
std::vector<Piece> parallel_pieces(std::size_t count, std::size_t grain, const Body& body,
                                   const Piece& initial = {}) {
    std::vector<Piece> pieces((count + grain - 1) / grain, initial);
    parallel_for(count, grain,
                 [&](std::size_t begin, std::size_t end) { body(begin, end, pieces[begin / grain]); });
    return pieces;
}

/// Where part `part` of `count` items begins, if they are divided into `parts` of nearly equal length, in
/// order: the first ones are longer by one.
constexpr std::size_t begin_of_part(std::size_t count, std::size_t part, std::size_t parts) {
    return count / parts * part + std::min(part, count % parts);
}

/// Sorts a list, and leaves one of equal entries.
template<class List>
void sort_out(List& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Lists, one after the other.
template<class List>
List joined(std::vector<List> lists) {
    std::size_t size = 0;
    for (const List& list : lists) {
        size += list.size();
    }
    for (List& list : lists) {
        if (list.size() == size) { // the others are empty
            return std::move(list);
        }
    }
    List all;
    all.reserve(size);
    for (List& list : lists) {
        all.insert(all.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
        list = {};
    }
    return all;
}

/// body(begin, end, list) appends to the list of its piece; the lists come back joined, in the order of the
/// pieces.
template<class T, class Body>
std::vector<T> parallel_gather(std::size_t count, std::size_t grain, const Body& body) {
    return joined(parallel_pieces<std::vector<T>>(count, grain, body));
}

} // namespace slabhull
