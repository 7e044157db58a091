// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/block_numbers.h"

namespace slabhull {

/// Cells of blocks that ranks have, in the order of order_along_curve(): each rank gets a range of it, ranges
/// ascending with ranks, of equal lengths within half a percent. `mesh` has all points and this rank's cells,
/// with neighbours in the cap's numbers; the result has the points in their new order, and the new numbers.
/// Collective. Cost: a sort of the rank's cells, of all points on the first rank, and all cells are sent
/// once.
CapMesh<3> ordered_along_curve(CapMesh<3>&& mesh, const BlockNumbers& numbers, std::size_t fixed_points,
                               Communicator& ranks);

/// The same in the order of their numbers; points stay.
CapMesh<3> ordered_by_number(CapMesh<3>&& mesh, const BlockNumbers& numbers, Communicator& ranks);

} // namespace slabhull
