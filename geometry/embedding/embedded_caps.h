// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/joined_spans.h"
#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/adjacency.h"

#include <array>
#include <span>
#include <vector>

namespace slabhull {

/// Which cap a hull cell is in, by the times of its vertices.
enum class CapOf : unsigned char { none, first, last };

/// The earliest and the latest time of cells.
template<int D>
std::array<double, 2> time_span(const JoinedSpans<Point<D + 1>>& points, std::span<const Simplex<D>> cells);

/// The cap of each cell: all its vertices are at the earliest or at the latest time of the hull, `times`.
template<int D>
Array<CapOf> find_caps(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const std::array<double, 2>& times);

/// Whether neither cap crosses itself or a cell of the side, proven without testing pairs of cells:
///
/// - Every facet of the hull is in two cells of opposite induced orientation, the cells of a cap all have the
///   same sign, and their boundary bounds a domain (no crossings, properly nested). The number of cells over
///   a generic point is then the winding number of that boundary, 0 or 1: no two cells overlap. Nor do they
///   touch outside common faces: at an inner vertex, edge or facet the cells around it fill a neighbourhood,
///   which leaves no room for another, and boundary facets do not touch each other.
/// - A side cell meets the cap's time in the face of its vertices at that time. Each such face is in the
///   cap's boundary, so it meets the cap's cells in common faces only.
///
/// False only says that this proof fails. Cost: that of require_domain_boundary() for both caps.
template<int D>
bool caps_are_embedded(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const AdjacencyView<D>& adjacency, std::span<const CapOf> caps,
                       const std::array<double, 2>& times);

// The steps of that proof, for hulls of which each of several ranks has a part.

/// Cells of a hull whose facets are in two cells that agree.
template<int D>
struct CellsInCaps {
    std::span<const Point<D + 1>> points;
    std::span<const Simplex<D>> cells;
    std::span<const Neighbors<D>> neighbors;
    std::span<const CapOf> caps; ///< of the cells, then of others that are neighbours
};

/// The signs of a cap's cells in space.
struct CapSigns {
    bool positive = false;
    bool negative = false;
    bool flat = false;

    void add(const CapSigns& more) {
        positive |= more.positive;
        negative |= more.negative;
        flat |= more.flat;
    }
    /// The sign of all cells; 0 if signs differ, a cell is flat or there is none.
    int common() const { return flat ? 0 : int{positive} - int{negative}; }
};
template<int D>
CapSigns signs_of_cap(const CellsInCaps<D>& hull, CapOf cap);

/// The facets of a cap's cells towards others, outward in space where the cells are positive.
template<int D>
Array<Facet<D>> outer_facets(const CellsInCaps<D>& hull, CapOf cap);

/// Whether such facets, of cells of one sign, bound a domain.
template<int D>
bool bound_a_domain(Array<Facet<D>> facets, Array<Point<D>> points, int sign);

/// The edges of facets, sorted. For D = 2 the facets are the edges.
template<int D>
std::vector<std::array<Index, 2>> edges_of(std::span<const Facet<D>> facets);

/// Whether each side cell meets the time of a cap in a face of the cap's boundary. `on_boundary`: the number
/// of each point in the boundary, or no_index; `edges` of the boundary have these numbers.
template<int D>
bool side_keeps_to(const CellsInCaps<D>& hull, double time, std::span<const Index> on_boundary,
                   std::span<const std::array<Index, 2>> edges);

} // namespace slabhull
