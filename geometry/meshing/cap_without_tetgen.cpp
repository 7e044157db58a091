// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/error.h"

namespace slabhull {

bool has_tetgen() {
    return false;
}

CapMesh<3> fill_with_tetgen(const Boundary<3>&, const Surface<3>&, const SizeField<3>&, const CapOptions&) {
    throw UsageError{
        "this build has no TetGen: configure it with -DSLABHULL_TETGEN=ON to mesh 3D caps with it"};
}

} // namespace slabhull
