// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace slabhull::io {

/// MFEM's number for the simplex of a dimension: point, segment, triangle, tetrahedron.
constexpr int mfem_simplex_type(int dimension) {
    return dimension == 3 ? 4 : dimension;
}

} // namespace slabhull::io
