// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/geometry/projection.h"

#include <filesystem>
#include <string>
#include <vector>

namespace slabhull {

/// The projection surface in a file, as it lies at the start. D = 3: STEP and BREP (by their endings .step
/// .stp .brep .brp, where OpenCASCADE was built in), else a triangulated surface as io::read_surface() takes
/// it; D = 2: a curve as io::read_curve() takes it.
/// Adds what the reader remarks. Throws InputError naming the file, UsageError for a CAD file without
/// OpenCASCADE.
template<int D>
ProjectionSurfacePointer<D> surface_from_file(const std::filesystem::path& path,
                                              std::vector<std::string>& remarks);

} // namespace slabhull
