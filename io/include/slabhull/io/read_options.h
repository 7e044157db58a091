// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace slabhull::io {

/// How to read a file that says more than a soup holds, or says it in its own way.
struct ReadOptions {
    /// Of curved simplices in MSH, VTU, PVTU, legacy VTK, XDMF (there of one kind in a file), TetGen and
    /// Medit the corners are taken, with a remark, and points that are no corner left out; false: they are
    /// refused.
    bool linear = false;
    /// In VTU, PVTU, legacy VTK and XDMF: the array of integers over the cells that says the group of each;
    /// empty: of cells of several dimensions `gmsh:physical`, `medit:ref` or `patch`, the first there is.
    std::string patch_array;
};

} // namespace slabhull::io
