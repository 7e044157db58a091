// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/cone_cells.h"
#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

#include <vector>

namespace slabhull {

/// The simplices of a filling that are not positive, by exact sign, ascending.
template<int D>
std::vector<Index> not_positive(const Filling<D>& filling);

/// Makes simplices `bad`, those that are not positive, positive by moving vertices that are not on the hull:
/// centres of cones in space and time, other inner vertices within the instant of their level. A linear
/// program finds the place with the largest least distance to the opposite facets of the star; if that is
/// positive, so are all simplices of the star. A vertex moves only if that distance grows. Nearby vertices
/// move, too, if those of the simplices at fault are not enough. Vertices move one after the other, in rounds
/// that end when all simplices are positive or nothing helps. Returns the simplices that are not positive
/// yet. Cost: a pass over the filling per round, of which there are at most some thirty.
template<int D>
std::vector<Index> mend_cells(std::vector<Index> bad, std::size_t initial_cells, std::size_t layers,
                              Filling<D>& filling);

/// Throws GeometryError naming cells of the cap and layers of simplices that are not positive.
template<int D>
[[noreturn]] void refuse_cells(const std::vector<Index>& bad, const Filling<D>& filling,
                               const SlabColumns<D>& columns, const ConeCells<D>& cones);

} // namespace slabhull
