// SPDX-License-Identifier: BSD-3-Clause
#include "topology/complex/edge_numbering.h"

#include "slabhull/core/parallel.h"
#include "topology/complex/star.h"

#include <algorithm>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t vertices_per_task = 1 << 13;

/// Calls visit(vertex, star, numbering of the link vertices above it) for every used vertex, in parallel.
/// The walk starts from the first cell of the vertex, so the numbering does not depend on the threads.
template<class Visit>
void each_upper_link(std::span<const Simplex<3>> cells, std::span<const Neighbors<3>> neighbors,
                     std::span<const Index> first_cell, const Visit& visit) {
    parallel_for(first_cell.size(), vertices_per_task, [&](std::size_t begin, std::size_t end) {
        StarWalker<3> walker{cells, neighbors};
        LocalNumbering above;
        for (std::size_t v = begin; v < end; ++v) {
            if (first_cell[v] == no_index) {
                continue;
            }
            above.clear();
            const auto star = walker.walk(static_cast<Index>(v), first_cell[v]);
            for (const Index c : star) {
                for (const Index w : cells[c]) {
                    if (w > v) {
                        above.number(w);
                    }
                }
            }
            visit(static_cast<Index>(v), star, above);
        }
    });
}

std::vector<Index> first_cells(std::span<const Simplex<3>> cells, std::size_t vertex_count) {
    std::vector<Index> first(vertex_count, no_index);
    for (std::size_t c = cells.size(); c-- > 0;) {
        for (const Index v : cells[c]) {
            first[v] = static_cast<Index>(c);
        }
    }
    return first;
}

} // namespace

EdgeNumbering number_edges(std::span<const Simplex<3>> cells, std::size_t vertex_count,
                           std::span<const Neighbors<3>> neighbors) {
    const std::vector<Index> first = first_cells(cells, vertex_count);
    std::vector<std::size_t> base(vertex_count + 1, 0);
    each_upper_link(
        cells, neighbors, first,
        [&](Index v, std::span<const Index>, const LocalNumbering& above) { base[v + 1] = above.size(); });
    for (std::size_t v = 0; v < vertex_count; ++v) {
        base[v + 1] += base[v];
    }
    EdgeNumbering edges;
    edges.count = checked_index(base[vertex_count], "edges");
    edges.of_cell.resize(cells.size());
    each_upper_link(
        cells, neighbors, first, [&](Index v, std::span<const Index> star, LocalNumbering& above) {
            for (const Index c : star) {
                const auto at = static_cast<std::size_t>(std::find(cells[c].begin(), cells[c].end(), v) -
                                                         cells[c].begin());
                for (std::size_t i = 0; i < 4; ++i) {
                    if (cells[c][i] > v) {
                        const Index number = above.number(cells[c][i]);
                        edges.of_cell[c][tetrahedron_edge(at, i)] = static_cast<Index>(base[v] + number);
                    }
                }
            }
        });
    return edges;
}

} // namespace slabhull
