// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/point.h"

#include <optional>

namespace slabhull {

/// A point that two non-degenerate, different (N-1)-simplices of R^N have in common off the face of the
/// vertices they share, rounded; nothing when there is none, which is decided without rounding, by a
/// feasibility program in rational numbers (CGAL). Cost: about a tenth of a millisecond.
template<int N>
std::optional<Point<N>> common_point(const FacetPair<N>& pair);

} // namespace slabhull
