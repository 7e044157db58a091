// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/coarse_space.h"

namespace slabhull::detail {

/// Solves S x = 0 in the rows of the free vertices, for all lanes at once. x has scaled unknowns: the values
/// of the fixed vertices, and zeros. Conjugate gradients, preconditioned by the diagonal and a CoarseSpace,
/// until the residual of each lane is `tolerance` times the initial one, or for `most` iterations. Sums are
/// in double precision and in fixed pieces: the same for any number of threads.
/// Returns the number of iterations.
int solve_for_free(const Stiffness& matrix, Array<Lanes>& x, double tolerance, int most);

} // namespace slabhull::detail
