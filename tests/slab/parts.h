// SPDX-License-Identifier: BSD-3-Clause
// Meshes divided among ranks, for tests.
#pragma once

#include "core/pieces.h"
#include "geometry/embedding/embedded_caps.h"
#include "slab/check/part_embedding.h"
#include "slabhull/core/communicator.h"
#include "slabhull/slab/hull_part.h"
#include "slabhull/topology/adjacency.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace slabhull::tests {

/// Some cells of a mesh as a rank has them, without ids. `neighbor_of(cell, i)`: where there is none, the
/// cell itself, which no part takes for a neighbour.
template<int D, class NeighborOf>
HullPart<D> part_of(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                    const NeighborOf& neighbor_of, const HullRange& range) {
    HullPart<D> part;
    part.hull_cells = cells.size();
    part.range = range;
    auto used = std::make_shared<PointSet>(points.size());
    for (std::size_t c = range.first; c < range.end(); ++c) {
        part.cells.push_back(cells[c]);
        for (std::size_t i = 0; i <= D; ++i) {
            used->insert(cells[c][i]);
            const std::uint64_t n = neighbor_of(c, i);
            if (!range.contains(n)) {
                part.outside.push_back(n);
            }
        }
    }
    sort_out(part.outside);
    used->count();
    for (std::size_t c = 0; c < range.count; ++c) {
        Neighbors<D>& row = part.neighbors.emplace_back();
        for (std::size_t i = 0; i <= D; ++i) {
            part.cells[c][i] = static_cast<Index>(used->rank(part.cells[c][i]));
            const std::uint64_t n = neighbor_of(range.first + c, i);
            const auto place = std::lower_bound(part.outside.begin(), part.outside.end(), n);
            row[i] = static_cast<Index>(
                range.contains(n) ? n - range.first
                                  : range.count + static_cast<std::size_t>(place - part.outside.begin()));
        }
    }
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (used->contains(v)) {
            part.points.push_back(points[v]);
        }
    }
    part.points_used = std::move(used);
    return part;
}

template<class Crossings>
std::set<std::pair<Index, Index>> pairs_in(const Crossings& crossings) {
    std::set<std::pair<Index, Index>> pairs;
    for (const auto& crossing : crossings) {
        if (crossing.first != crossing.second) { // cells without extent are the check's own
            pairs.emplace(crossing.first, crossing.second);
        }
    }
    return pairs;
}

/// Ranks must find the crossings that the search of the whole has found, wherever parts begin.
template<int D>
void require_same_in_ranks(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                           const Adjacency<D>& adjacency, std::size_t limit, const HullEmbedding<D>& whole) {
    static int cases = 0;
    if (!adjacency.defects.empty() || cells.size() < 4) {
        return; // ranks examine hulls that are closed
    }
    const int ranks = 2 + cases++ % 3;
    std::vector<PartsEmbedding<D>> found(static_cast<std::size_t>(ranks));
    run_team(ranks, [&](Communicator& team) {
        const auto r = static_cast<std::size_t>(team.rank());
        const HullPart<D> part = part_of<D>(
            points, cells, [&](std::size_t c, std::size_t i) { return adjacency.neighbors[c][i]; },
            range_of_part(cells.size(), r, found.size()));
        found[r] = examine_parts<D>(part, team, limit);
    });
    for (const PartsEmbedding<D>& each : found) {
        INFO(ranks << " ranks");
        std::vector<Crossing<D + 1>> crossings;
        for (const CrossingInHull<D>& crossing : each.crossings) {
            crossings.push_back(crossing.cells);
            REQUIRE(crossing.times[0] == time_span<D>(points, {&cells[crossing.cells.first], 1}));
            REQUIRE(crossing.times[1] == time_span<D>(points, {&cells[crossing.cells.second], 1}));
        }
        REQUIRE(each.all.caps_proven == whole.caps_proven);
        REQUIRE(each.all.tested_cells == whole.tested_cells);
        REQUIRE(each.all.all_listed == whole.all_listed);
        REQUIRE((!whole.all_listed || pairs_in(crossings) == pairs_in(whole.crossings)));
        REQUIRE(crossings.size() <= limit);
    }
}

} // namespace slabhull::tests
