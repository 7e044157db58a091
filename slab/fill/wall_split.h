// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/slab_columns.h"
#include "slabhull/topology/hull.h"

#include <array>
#include <cstddef>

namespace slabhull {

/// How the quadrilateral over an edge of the cap is split, for its columns a < b: around a centre, or by the
/// diagonal from a below to b above ("rising") or from b below to a above.
struct QuadSplit {
    Index centre = no_index;
    bool rising = true;

    bool staircase() const { return centre == no_index && rising; }
    std::size_t pieces() const { return centre == no_index ? 2 : 4; }
};

/// Cells of a hull that follow one another.
struct CellRange {
    Index first;
    Index end;

    bool has(Index cell) const { return first <= cell && cell < end; }
};

/// Whether the hull's cells over a facet, in a layer, are the staircase of its columns, which ascend.
template<int D>
bool is_staircase(const Hull<D>& hull, const SlabColumns<D>& columns, std::size_t layer,
                  const CellRange& cells, const Facet<D>& corners);

/// The split of the quadrilateral over an edge between columns a < b, which the cells have on their outside.
/// Throws GeometryError if there is none.
template<int D>
QuadSplit read_quad_split(const Hull<D>& hull, const SlabColumns<D>& columns, std::size_t layer,
                          const CellRange& cells, const std::array<Index, 2>& edge);

} // namespace slabhull
