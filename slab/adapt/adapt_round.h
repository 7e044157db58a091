// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"
#include "slab/adapt/boundary_operations.h"

#include <array>
#include <vector>

namespace slabhull {

/// The operations of one layer, which share no cell: chosen greedily by urgency, ties by columns. Splits
/// edges that are too long for their target, collapses those too short, and changes the connectivity at cells
/// of small angles. Each can be coned with positive volumes. `boundary`: none if that stays as it is. Adds to
/// the report what was refused.
template<int D>
std::vector<Cavity<D>> choose_operations(const AdaptMesh<D>& mesh, const BoundaryOperations<D>* boundary,
                                         const std::array<double, 2>& times, const AdaptOptions& options,
                                         AdaptReport& report);

/// Least and largest length of edges inside over their target at the layer's end.
template<int D>
std::array<double, 2> length_ratios(const AdaptMesh<D>& mesh);

} // namespace slabhull
