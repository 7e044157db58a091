// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point_set.h"
#include "slabhull/slab/hull_columns.h"
#include "slabhull/topology/hull.h"

#include <cstdint>
#include <memory>

namespace slabhull {

class Communicator;

/// A range of a hull's cells with the points that these use, as one of several ranks holds it. Vertices and
/// neighbours are numbers within the part, of 32 bits; numbers in the whole hull have 64.
template<int D>
struct HullPart {
    std::size_t hull_cells = 0; ///< of the whole hull
    HullRange range;            ///< which of them are here
    Array<Simplex<D>> cells;
    /// A cell of the part, or cells.size() + k for outside[k].
    Array<Neighbors<D>> neighbors;
    Array<std::uint64_t> outside;                ///< the cells of other parts next to those here, ascending
    std::shared_ptr<const PointSet> points_used; ///< which of the hull's points are here
    Array<Point<D + 1>> points;
    IntegerList vertex_ids;
    IntegerList track_ids;

    std::size_t hull_points() const { return points_used->all(); }
    /// The whole hull's number of a neighbour.
    std::uint64_t in_hull(Index neighbor) const {
        return neighbor < cells.size() ? range.first + neighbor : outside[neighbor - cells.size()];
    }
};

/// Range `part` of `parts` that so many cells, or layers, are divided into: of nearly equal length, in order.
HullRange range_of_part(std::size_t cells, std::size_t part, std::size_t parts);
/// This rank's.
HullRange range_of_rank(std::size_t cells, const Communicator& ranks);

} // namespace slabhull
