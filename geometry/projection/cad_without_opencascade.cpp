// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cad_surface.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

namespace slabhull {

bool has_cad_surfaces() {
    return false;
}

ProjectionSurfacePointer<3> cad_surface(std::istream&, CadFormat, const std::string& name) {
    throw UsageError{fmt::format(
        "{}: this build reads no CAD files, since it was made without OpenCASCADE. Install Debian's "
        "libocct-modeling-algorithms-dev and libocct-data-exchange-dev and build with "
        "-DSLABHULL_OPENCASCADE=ON, or give a triangulated surface (STL, OFF, OBJ, PLY)",
        name)};
}

} // namespace slabhull
