// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/formats.h"
#include "slabhull/io/soup.h"

namespace slabhull {

/// Formats of named groups, and those that keep no arrays, get groups. Where groups lose their names, only
/// those of hulls, which tell the regions, become arrays.
void settle_groups(const io::Format& format, io::Soup& soup);

/// The columns of a soup, which must outlive them. Hulls keep the types that docs/formats.md gives their
/// arrays.
io::MeshColumns columns_to_write(const io::Soup& soup);

} // namespace slabhull
