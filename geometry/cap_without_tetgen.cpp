// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_mesher.h"

#include "slabhull/core/error.h"

namespace slabhull {

template<>
CapMesh<3> mesh_cap<3>(const Surface<3>&, const CapOptions&) {
    throw GeometryError{
        "this build has no 3D mesher: configure it with -DSLABHULL_TETGEN=ON to mesh 3D caps"};
}

} // namespace slabhull
