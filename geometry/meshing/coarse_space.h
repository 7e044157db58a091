// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include "geometry/meshing/stiffness.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <vector>

namespace slabhull::detail {

/// Up to four unknowns of a vertex, side by side in one register.
using Lanes = Eigen::Array4f;
/// One sum per lane.
using Sums = Eigen::Array4d;

/// The coarse space of displacements that are constant on connected groups of some hundred free vertices.
/// Conjugate gradients carry a boundary's motion inwards by one edge per iteration, a coarse correction all
/// the way at once; so the number of iterations hardly grows with the mesh. (Two-level additive Schwarz;
/// Nicolaides, SIAM Journal on Numerical Analysis 24, 1987.)
class CoarseSpace {
public:
    /// Cost: linear, and the Cholesky factorisation of a matrix of a few thousand rows.
    explicit CoarseSpace(const Stiffness& matrix);

    /// Computes the coarse correction of a residual, in scaled unknowns: add correction(v) at each free
    /// vertex. Returns the inner product of residual and correction.
    Sums solve(const Array<Lanes>& residual);
    Lanes correction(std::size_t v) const { return matrix_.root[v] * by_group_[group_[v]]; }

private:
    void grow_group(Index seed, std::size_t size);
    void factorise();

    const Stiffness& matrix_;
    std::vector<Index> group_;       ///< group of each vertex; fixed vertices are in an extra last group
    std::vector<Index> members_;     ///< group by group
    std::vector<std::size_t> first_; ///< of each group in members_
    Array<Lanes> by_group_;
    Eigen::MatrixX4d right_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

} // namespace slabhull::detail
