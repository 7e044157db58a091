// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace slabhull::io {

/// Dimension of the simplex that has Gmsh's element type number, -1 for any other element.
constexpr int gmsh_simplex_dimension(int type) {
    switch (type) {
    case 15:
        return 0;
    case 1:
        return 1;
    case 2:
        return 2;
    case 4:
        return 3;
    default:
        return -1;
    }
}

/// Gmsh's element type number of a point, line, triangle or tetrahedron.
constexpr int gmsh_simplex_type(int dimension) {
    return dimension == 0 ? 15 : dimension == 1 ? 1 : dimension == 2 ? 2 : 4;
}

/// What the user calls an element type that we refuse.
inline std::string gmsh_type_name(int type) {
    switch (type) {
    case 3:
        return "quadrangle";
    case 5:
        return "hexahedron";
    case 6:
        return "prism";
    case 7:
        return "pyramid";
    case 8:
        return "second-order line";
    case 9:
        return "second-order triangle";
    case 10:
    case 16:
        return "second-order quadrangle";
    case 11:
        return "second-order tetrahedron";
    case 12:
    case 17:
        return "second-order hexahedron";
    case 13:
    case 18:
        return "second-order prism";
    case 14:
    case 19:
        return "second-order pyramid";
    default:
        return "element of Gmsh's type " + std::to_string(type);
    }
}

} // namespace slabhull::io
