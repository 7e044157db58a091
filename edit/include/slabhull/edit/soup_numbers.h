// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

namespace slabhull {

// Files say the same things in two ways. Some have arrays: "region", "patch" and "neighbors" over the cells,
// "cell" over the points, counted from 0, and the patches' names as field data. Others have groups of cells,
// and "neighbor_0" .. "neighbor_D" and "cell" hold element tags, which count from 1.

/// Brings the numbers of vertices and cells in a soup to the first way: "neighbors" and "cell" count from 0,
/// -1 for none; ids, tracks, layers, regions and patches that a file stores as reals become whole numbers.
/// Throws InputError for a neighbor that does not exist.
void settle_numbers(io::Soup& soup);

/// The patches that the field data "patch_number" and "patch_name" list.
PatchList listed_patches(const io::Soup& soup);

/// "neighbors" and "cell" as element tags, for a format that has them so.
void number_by_tags(io::Soup& soup);

/// Makes "region" and "patch" and the patches' names of the groups of the cells, or only "patch" for a mesh
/// that is no hull. Leaves a soup alone that has such arrays, or no groups.
void groups_to_arrays(io::Soup& soup);

/// Makes groups of "region", "patch" and the patches' names. Leaves a soup alone that has groups already, or
/// whose arrays groups cannot express: a group is a positive number, a hull's caps have no patches.
void arrays_to_groups(io::Soup& soup);

} // namespace slabhull
