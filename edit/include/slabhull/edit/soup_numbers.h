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

/// Turns "neighbors" and "cell" into element tags, for formats that store these.
void number_by_tags(io::Soup& soup);

/// Adds the arrays "region" and "patch" and the patches' names from the groups of the cells; for a mesh that
/// is not a hull only "patch". Does nothing if the soup has such arrays already, or no groups.
void groups_to_arrays(io::Soup& soup);

/// Adds groups from "region", "patch" and the patches' names. Does nothing if the soup has groups already, or
/// if groups cannot express the arrays: a group is a positive number, a hull's caps have no patches.
void arrays_to_groups(io::Soup& soup);

} // namespace slabhull
