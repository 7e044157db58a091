// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/point.h"

#include <optional>

namespace slabhull {

/// A common point, rounded, of two non-degenerate, different (N-1)-simplices of R^N outside the face of their
/// shared vertices; nothing if there is none. Decided exactly, by a feasibility program in rational numbers
/// (CGAL). Cost: about a tenth of a millisecond.
template<int N>
std::optional<Point<N>> common_point(const FacetPair<N>& pair);

} // namespace slabhull
