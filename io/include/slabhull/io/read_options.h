// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace slabhull::io {

/// How to read a file that holds more than a soup, or holds it in its own way.
struct ReadOptions {
    /// Reads only the corners of curved simplices in MSH, VTU, PVTU, legacy VTK, XDMF (there of one kind in a
    /// file), TetGen and Medit. Points that are not corners are left out, with a remark. false: curved
    /// simplices are refused.
    bool linear = false;
    /// In VTU, PVTU, legacy VTK and XDMF: the array of integers over the cells with the group of each. Empty:
    /// if cells have several dimensions, the first that exists of `gmsh:physical`, `medit:ref` and `patch`.
    std::string patch_array;
};

} // namespace slabhull::io
