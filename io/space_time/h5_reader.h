// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/space_time_files.h"

namespace slabhull::io {

/// Reads what write_h5() writes. Throws InputError; UsageError in a build without HDF5.
SpaceTimeSoup read_h5(const std::filesystem::path& path);

} // namespace slabhull::io
