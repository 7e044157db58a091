// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/wall_split.h"

#include "slab/fill/staircase.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace slabhull {

namespace {

template<std::size_t N>
std::array<Index, N> ascending(std::array<Index, N> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

template<std::size_t N>
bool contains(const std::array<Index, N>& cell, Index vertex) {
    return std::find(cell.begin(), cell.end(), vertex) != cell.end();
}

/// The centre of a quadrilateral: the third corner of the triangle with the bottom edge on the cells'
/// outside.
template<int D>
Index centre_of(const Hull<D>& hull, const CellRange& cells, const std::array<Index, 2>& bottom) {
    for (Index c = cells.first; c < cells.end; ++c) {
        if (!contains(hull.cells[c], bottom[0]) || !contains(hull.cells[c], bottom[1])) {
            continue;
        }
        for (std::size_t i = 0; i <= D; ++i) { // facet i is opposite to vertex i
            for (const Index v : hull.cells[c]) {
                if (!cells.has(hull.neighbors[c][i]) && !contains(bottom, hull.cells[c][i]) &&
                    !contains(bottom, v) && v != hull.cells[c][i] && hull.track_ids[v] == no_track) {
                    return v;
                }
            }
        }
    }
    throw GeometryError{
        fmt::format("the hull's side in its cells {} to {} is split neither by a diagonal nor by a centre "
                    "above vertices {} and {}; check the hull first",
                    cells.first, cells.end - 1, bottom[0], bottom[1]),
        {{"cell", cells.first, {}}}};
}

} // namespace

template<int D>
bool is_staircase(const Hull<D>& hull, const SlabColumns<D>& columns, std::size_t layer,
                  const CellRange& cells, const Facet<D>& corners) {
    if (cells.end - cells.first != D) {
        return false;
    }
    std::array<Simplex<D>, D> there;
    std::array<Simplex<D>, D> expected;
    for (std::size_t m = 0; m < D; ++m) {
        there[m] = ascending(hull.cells[cells.first + m]);
        expected[m] = ascending(staircase_piece<D>(columns, layer, corners, m));
    }
    std::sort(there.begin(), there.end());
    std::sort(expected.begin(), expected.end());
    return there == expected;
}

template<int D>
QuadSplit read_quad_split(const Hull<D>& hull, const SlabColumns<D>& columns, std::size_t layer,
                          const CellRange& cells, const std::array<Index, 2>& edge) {
    const std::array<Index, 2> below{columns.at(layer, edge[0]), columns.at(layer, edge[1])};
    const std::array<Index, 2> above{columns.at(layer + 1, edge[0]), columns.at(layer + 1, edge[1])};
    bool rising = false;
    bool falling = false;
    for (Index c = cells.first; c < cells.end; ++c) {
        rising = rising || (contains(hull.cells[c], below[0]) && contains(hull.cells[c], above[1]));
        falling = falling || (contains(hull.cells[c], below[1]) && contains(hull.cells[c], above[0]));
    }
    QuadSplit split;
    split.rising = rising;
    split.centre = rising || falling ? no_index : centre_of<D>(hull, cells, below);
    return split;
}

template bool is_staircase<2>(const Hull<2>&, const SlabColumns<2>&, std::size_t, const CellRange&,
                              const Facet<2>&);
template bool is_staircase<3>(const Hull<3>&, const SlabColumns<3>&, std::size_t, const CellRange&,
                              const Facet<3>&);
template QuadSplit read_quad_split<3>(const Hull<3>&, const SlabColumns<3>&, std::size_t, const CellRange&,
                                      const std::array<Index, 2>&);

} // namespace slabhull
