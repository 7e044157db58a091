// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <array>

namespace slabhull {

/// A point of R^N; space-time points have t last.
template<int N>
using Point = std::array<double, N>;

/// The vertices of a simplex of dimension D. Facet i of a simplex is the one opposite to its vertex i.
template<int D>
using Simplex = std::array<Index, D + 1>;

/// A facet of a D-simplex: a simplex of dimension D - 1.
template<int D>
using Facet = std::array<Index, D>;

/// The cells across the facets of a D-simplex: neighbors[i] is across the facet opposite to vertex i.
template<int D>
using Neighbors = std::array<Index, D + 1>;

} // namespace slabhull
