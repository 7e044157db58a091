// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/findings.h"
#include "topology/complex/repeated_vertex.h"

#include <span>

namespace slabhull {

// Checks that hulls and spatial meshes share. N is the dimension of the points.

/// Checks the vertices of cells; false if the cells cannot be examined further.
template<int D>
bool check_indices(std::span<const Simplex<D>> cells, std::size_t vertex_count, Findings& findings);

/// Checks coordinates; false if some are unfit for geometry.
template<int N>
bool check_finite(std::span<const Point<N>> points, Findings& findings);

template<int N>
void check_coincident(std::span<const Point<N>> points, Findings& findings);

/// Whether a cell's measure is below 1e-14 of its longest edge in space to the power D; where it lasts longer
/// than that, one factor is its extent in time.
template<int D, int N>
bool is_degenerate(const std::array<Point<N>, D + 1>& corners);
/// The same for a cell whose measure is known.
template<int D, int N>
bool is_degenerate(const std::array<Point<N>, D + 1>& corners, double measure);

template<int D, int N>
void report_degenerate(std::span<const Point<N>> points, std::span<const Simplex<D>> cells,
                       std::span<const Index> degenerate, Findings& findings);

template<int D, int N>
void check_degenerate(std::span<const Point<N>> points, std::span<const Simplex<D>> cells,
                      Findings& findings);

/// Adds the findings of examine_manifold() and their counts, except for some kinds.
void translate(const ManifoldReport& report, std::initializer_list<ManifoldDefect> except,
               Findings& findings);

} // namespace slabhull
