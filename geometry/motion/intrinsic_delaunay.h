// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/boundary.h"

#include <span>
#include <vector>

namespace slabhull::detail {

/// A weighted edge of a graph Laplacian.
struct WeightedEdge {
    Index from;
    Index to;
    double weight;
};

/// Cotangent weights (cot alpha + cot beta) / 2 of some facets of a boundary at the start, never negative on
/// inner edges.
///
/// The edges are those of the surface's intrinsic Delaunay triangulation: edges of the given triangles are
/// flipped on the surface, which does not change its shape, until all weights are non-negative. So a harmonic
/// function stays between its boundary values whatever the triangles' angles, and on a flat piece linear
/// functions are harmonic. Edges on the rim of the piece are not flipped and may have a negative weight. An
/// edge may occur more than once.
/// Fisher, Springborn, Bobenko, Schroeder, "An algorithm for the construction of intrinsic Delaunay
/// triangulations with applications to digital geometry processing" (2007).
///
/// Needs: facets in ascending order.
/// Cost: near-linear where few edges must be flipped.
std::vector<WeightedEdge> cotangent_edges(const Boundary<3>& boundary, std::span<const Index> facets);

} // namespace slabhull::detail
