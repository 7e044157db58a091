// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <vector>

namespace slabhull::io {

/// The groups of a mesh to be written; one without number or name if none are given. Throws
/// std::invalid_argument if they do not contain all cells in order; `writer` names the function at fault.
std::vector<MeshColumns::Group> checked_groups(const Column<std::int64_t>& cells,
                                               const std::vector<MeshColumns::Group>& groups,
                                               const char* writer);

/// Adds the groups that simplices of a soup are in to its lists, without names.
void list_groups_in_use(Soup& soup);

} // namespace slabhull::io
