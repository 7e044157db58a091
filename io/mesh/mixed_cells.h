// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <string>

namespace slabhull::io {

/// Finishes a soup of cells of several dimensions, whose tags are their rows in the arrays over all cells.
/// Groups of all dimensions are the positive integers of the array `patch_array` or, if that is empty, of the
/// first that exists of `gmsh:physical` (meshio), `medit:ref` and `patch`. Field data `patch_number` and
/// `patch_name` give their names, if they exist. Then cell data keep only the rows of cells of the largest
/// dimension. Throws InputError if there is no array `patch_array`.
void settle_mixed_cells(Soup& soup, const std::string& patch_array);

/// Only makes the groups, if `patch_array` is not empty: for cells of one dimension.
void settle_equal_cells(Soup& soup, const std::string& patch_array);

} // namespace slabhull::io
