// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <string>

namespace slabhull::io {

/// Ends the reading of cells of several dimensions, whose tags are their rows in the arrays over all cells.
/// Groups of all dimensions come from the integers of the array called `patch_array` or, where that is empty,
/// of the first there is of `gmsh:physical` (meshio), `medit:ref` and `patch`: positive values, named by the
/// field data `patch_number` and `patch_name` where these are there. Then cell data keep the rows of the
/// cells of the largest dimension. Throws InputError for a `patch_array` that is not there.
void settle_mixed_cells(Soup& soup, const std::string& patch_array);

/// The same for groups alone where all cells are of one dimension and `patch_array` is not empty.
void settle_equal_cells(Soup& soup, const std::string& patch_array);

} // namespace slabhull::io
