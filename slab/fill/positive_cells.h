// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/fill/cone_cells.h"
#include "slab/fill/slab_columns.h"
#include "slabhull/topology/filling.h"

namespace slabhull {

/// Throws GeometryError naming cells of the cap and layers where simplices are not positive, by exact sign.
template<int D>
void require_positive(const Filling<D>& filling, const SlabColumns<D>& columns, const ConeCells<D>& cones);

extern template void require_positive<2>(const Filling<2>&, const SlabColumns<2>&, const ConeCells<2>&);
extern template void require_positive<3>(const Filling<3>&, const SlabColumns<3>&, const ConeCells<3>&);

} // namespace slabhull
