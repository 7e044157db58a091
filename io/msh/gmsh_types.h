// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace slabhull::io {

/// A Gmsh element type that is a simplex. Its corners, one more than its dimension, are its first nodes.
struct GmshSimplex {
    int dimension = -1; ///< -1: no simplex
    int nodes = 0;

    bool is_curved() const { return nodes > dimension + 1; }
};

constexpr GmshSimplex gmsh_simplex(int type) {
    switch (type) {
    case 15:
        return {0, 1};
    case 1:
        return {1, 2};
    case 2:
        return {2, 3};
    case 4:
        return {3, 4};
    case 8: // second order
        return {1, 3};
    case 9:
        return {2, 6};
    case 11:
        return {3, 10};
    case 26: // third
        return {1, 4};
    case 21:
        return {2, 10};
    case 29:
        return {3, 20};
    case 27: // fourth
        return {1, 5};
    case 23:
        return {2, 15};
    case 30:
        return {3, 35};
    default:
        return {};
    }
}

/// Gmsh's element type number of a point, line, triangle or tetrahedron.
constexpr int gmsh_simplex_type(int dimension) {
    return dimension == 0 ? 15 : dimension == 1 ? 1 : dimension == 2 ? 2 : 4;
}

/// The user's name of an element type that we refuse.
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
    case 26:
        return "third-order line";
    case 21:
        return "third-order triangle";
    case 29:
        return "third-order tetrahedron";
    default:
        return "element of Gmsh's type " + std::to_string(type);
    }
}

} // namespace slabhull::io
