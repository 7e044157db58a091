// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/joined_spans.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/point.h"
#include "slabhull/geometry/embedding.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// Whether a D-simplex in R^(D+1) has no extent. Exact.
bool degenerate(const std::array<Point<3>, 3>& triangle);
bool degenerate(const std::array<Point<4>, 4>& tetrahedron);

template<int D>
Box<D + 1> box_of(const Simplex<D>& cell, const JoinedSpans<Point<D + 1>>& points) {
    Box<D + 1> box;
    for (const Index v : cell) {
        box.include(points[v]);
    }
    return box;
}

/// The inverse of the cells' mean extent along each axis (sampled), rounded to a power of two: balances
/// lengths and times. It affects the speed of a search, not its result.
template<int D>
Point<D + 1> scale_of_cells(const JoinedSpans<Point<D + 1>>& points, std::span<const Simplex<D>> cells);

/// The crossing cells found, and statistics.
template<int D>
struct PairTally {
    std::vector<Crossing<D + 1>> crossings;
    std::size_t tested = 0;
    std::size_t exact = 0; ///< decided by rational arithmetic
};

/// Decides pairs of non-degenerate cells one by one, exactly.
template<int D>
class CellPairs {
public:
    CellPairs(const JoinedSpans<Point<D + 1>>& points, const JoinedSpans<Simplex<D>>& cells,
              const Point<D + 1>& scale)
        : points_{points}, cells_{cells}, scale_{scale} {}

    /// Counts the pair in `tally`, and adds it to the crossings if the two cells have a common point outside
    /// the face of their shared vertices.
    void decide(Index first, Index second, PairTally<D>& tally) const;

private:
    FacetPair<D + 1> pair_of(Index first, Index second) const;

    JoinedSpans<Point<D + 1>> points_;
    JoinedSpans<Simplex<D>> cells_;
    Point<D + 1> scale_;
};

extern template class CellPairs<2>;
extern template class CellPairs<3>;

} // namespace slabhull
