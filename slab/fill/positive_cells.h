// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/cone_cells.h"
#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

namespace slabhull {

/// Throws GeometryError naming cells of the cap and layers where simplices are not positive, by exact sign.
template<int D>
void require_positive(const Filling<D>& filling, const SlabColumns<D>& columns, const ConeCells<D>& cones);

} // namespace slabhull
