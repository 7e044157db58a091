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
/// One number per lane, to add up in.
using Sums = Eigen::Array4d;

/// Displacements that are constant on connected groups of some hundred free vertices. Conjugate gradients
/// carry a boundary's motion inwards by one edge per iteration; a correction from this space carries it all
/// the way in one, which leaves an iteration number that hardly grows with the mesh. (Two-level additive
/// Schwarz; Nicolaides, SIAM Journal on Numerical Analysis 24, 1987.)
class CoarseSpace {
public:
    /// Cost: linear, and the Cholesky factorisation of a matrix of a few thousand rows.
    explicit CoarseSpace(const Stiffness& matrix);

    /// Computes the correction of a residual: correction(v) is to be added at each free vertex, in scaled
    /// unknowns. Returns the product of the two.
    Sums solve(const Array<Lanes>& residual);
    Lanes correction(std::size_t v) const { return matrix_.root[v] * by_group_[group_[v]]; }

private:
    void grow_group(Index seed, std::size_t size);
    void factorise();

    const Stiffness& matrix_;
    std::vector<Index> group_;       ///< of each vertex; the fixed ones are in the group after the last
    std::vector<Index> members_;     ///< group by group
    std::vector<std::size_t> first_; ///< of each group in members_
    Array<Lanes> by_group_;
    Eigen::MatrixX4d right_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

} // namespace slabhull::detail
