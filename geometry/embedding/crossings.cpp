// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/embedding.h"

#include "core/pieces.h"

#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <tuple>

namespace slabhull {

namespace {

template<int D>
std::vector<Crossing<D>> degenerate_facets(const Array<Box<D>>& boxes) {
    std::vector<Crossing<D>> found;
    for (std::size_t f = 0; f < boxes.size(); ++f) {
        if (boxes[f].empty()) {
            found.push_back({static_cast<Index>(f), static_cast<Index>(f), {}});
        }
    }
    return found;
}

/// Crossings found from the blocks [begin, end) of the tree, at most `limit`.
template<int D>
std::vector<Crossing<D>> crossings_from(const Surface<D>& surface, const BoxTree<D>& tree, std::size_t begin,
                                        std::size_t end, std::size_t limit) {
    std::vector<Crossing<D>> found;
    for (std::size_t block = begin; block < end && found.size() < limit; ++block) {
        tree.find_pairs(block, [&](Index a, Index b) {
            const auto [first, second] = std::minmax(a, b);
            if (found.size() < limit && meet_elsewhere(pair_of_facets(surface, first, second))) {
                found.push_back({first, second, {}});
            }
        });
    }
    return found;
}

template<int D>
Point<D> place_of(const Surface<D>& surface, const Crossing<D>& crossing) {
    return crossing.first == crossing.second
               ? surface.points[surface.facets[crossing.first][0]]
               : meeting_place(pair_of_facets(surface, crossing.first, crossing.second));
}

} // namespace

template<int D>
std::vector<Crossing<D>> find_crossings(const Surface<D>& surface, std::size_t limit) {
    const Array<Box<D>> boxes = facet_boxes(surface);
    std::vector<Crossing<D>> all = degenerate_facets(boxes);
    const BoxTree<D> tree{boxes};
    constexpr std::size_t grain = 256;
    const auto found = parallel_gather<Crossing<D>>(
        tree.blocks(), grain, [&](std::size_t begin, std::size_t end, std::vector<Crossing<D>>& piece) {
            piece = crossings_from(surface, tree, begin, end, limit);
        });
    all.insert(all.end(), found.begin(), found.end());
    std::sort(all.begin(), all.end(), [](const Crossing<D>& a, const Crossing<D>& b) {
        return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
    if (all.size() > limit) {
        all.resize(limit);
    }
    for (Crossing<D>& crossing : all) {
        crossing.near = place_of(surface, crossing);
    }
    return all;
}

template std::vector<Crossing<2>> find_crossings<2>(const Surface<2>&, std::size_t);
template std::vector<Crossing<3>> find_crossings<3>(const Surface<3>&, std::size_t);

} // namespace slabhull
