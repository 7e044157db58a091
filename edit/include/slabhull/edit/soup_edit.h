// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace slabhull {

// What `slabhull convert` does to a mesh between reading and writing. Data, groups and the file's own numbers
// go with the points and cells that stay, bit for bit. "neighbors" (-1 where a cell is gone) and "cell" stay
// right; they must count from 0, as settle_numbers() leaves them. Cost: near-linear, one further copy of what
// changes.

/// Leaves only one region of a hull, 0 initial, 1 side or 2 terminating, and the points that it uses. The
/// regions are those of the array "region" or of the groups' names. Throws UsageError when the soup is not a
/// hull with regions, InputError when nothing would be left.
void select_region(io::Soup& soup, int region);

/// The simplices, of whatever dimension, in all groups and on all patches that are called `name`, as
/// group_name() has it, and the points that they use. Throws UsageError naming the patches that there are.
void select_patch(io::Soup& soup, const std::string& name);

/// Simplices of a soup that belong together.
struct SoupPart {
    std::string name;
    std::array<Array<Index>, 4> cells; ///< by dimension, ascending
};
/// Every simplex is in one part. Of a hull: "initial", "terminating" and the patches of its side; of another
/// mesh its patches or groups, where groups of several dimensions with one name are one part. A patch without
/// a name is "patch_" and its number; what is in none is the part "rest".
std::vector<SoupPart> parts_of(const io::Soup& soup);
/// Leaves only that part and the points that it uses. Throws InputError when it has no cells.
void keep_part(io::Soup& soup, const SoupPart& part);

/// Leaves the boundary of triangles or tetrahedra: the facets of one cell only, oriented outward as in
/// docs/architecture.md (as the cells are oriented), and their points. A facet gets the data of its cell,
/// except "neighbors", and the group of the same facet in the soup; if the soup lists no facets, its cell's.
/// Throws UsageError for other soups and InputError when there is no boundary or a cell repeats a vertex.
void extract_boundary(io::Soup& soup);

/// How much was welded.
struct Welded {
    std::size_t points = 0; ///< removed
    std::size_t cells = 0;  ///< removed since they collapsed, of all dimensions
};
/// Replaces a point by an earlier one that stays and lies within `tolerance` (at least 0; in space-time for a
/// hull), not necessarily the nearest. Neighbors are found anew.
Welded weld(io::Soup& soup, double tolerance);

/// Renumbers points and cells along a space-filling curve, by their places in space (D = 2: in space-time).
void renumber_along_curve(io::Soup& soup);

/// Multiplies space by `factor`; time stays. Throws GeometryError naming the first point that is not finite
/// then.
void scale(io::Soup& soup, double factor);

/// Drops what an adapted hull's cap was held to. To fill the hull, its cap is adapted again, bit for bit,
/// which needs the hull as it was built. Returns whether there was anything.
bool drop_adaptation(io::Soup& soup);

/// Turns the orientation of all simplices round by swapping their first two vertices.
void reverse(io::Soup& soup);

/// Whether the last of the three coordinates of a soup's points is a hull's time: triangles with groups of
/// regions, or with a point array "t" equal to it.
bool has_time_as_coordinate(const io::Soup& soup);

} // namespace slabhull
