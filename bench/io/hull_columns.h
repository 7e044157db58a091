// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hull_soup.h"
#include "slabhull/io/soup.h"

namespace slabhull::bench {

/// The soup as our writers take it, with all arrays of a hull as VTU.
io::MeshColumns hull_columns(const HullSoup& soup);
/// Points and cells in groups, without data: what others' writers of MSH take.
io::MeshColumns mesh_columns(const HullSoup& soup);

/// Whether points and cells are those of the soup; coordinates but for a relative error.
bool is_mesh(const io::Soup& found, const HullSoup& soup, double tolerance = 0);
/// And all arrays, too.
bool is_hull(const io::Soup& found, const HullSoup& soup);

} // namespace slabhull::bench
