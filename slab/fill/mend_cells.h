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

/// Moves vertices off the hull where simplices are not positive: centres of cones in space and time, vertices
/// inside on the instant of their level. Each goes where the least distance to the facets of its star that it
/// sees is largest, which is a linear program; where that is positive, all simplices of the star are. It
/// moves only if that distance grows. Vertices near by are moved, too, where those of the simplices at fault
/// are not enough. One after the other, in rounds that end when all is positive or nothing helps.
/// Cost: a pass over the filling per round, of which there are at most some thirty.
template<int D>
void mend_cells(const SlabColumns<D>& columns, Filling<D>& filling);

/// Throws GeometryError naming cells of the cap and layers of simplices that are not positive.
template<int D>
[[noreturn]] void refuse_cells(const std::vector<Index>& bad, const Filling<D>& filling,
                               const SlabColumns<D>& columns, const ConeCells<D>& cones);

} // namespace slabhull
