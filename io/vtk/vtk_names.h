// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace slabhull::io {

/// Our attribute of a UInt8 array that holds texts, each ended by a zero byte. Other readers see numbers.
inline constexpr const char* text_mark = "slabhull_text";

/// VTK's name of a scalar type.
template<class T>
constexpr const char* vtk_name() {
    if constexpr (std::floating_point<T>) {
        return sizeof(T) == 4 ? "Float32" : "Float64";
    } else if constexpr (std::signed_integral<T>) {
        return sizeof(T) == 1 ? "Int8" : sizeof(T) == 2 ? "Int16" : sizeof(T) == 4 ? "Int32" : "Int64";
    } else {
        return sizeof(T) == 1 ? "UInt8" : sizeof(T) == 2 ? "UInt16" : sizeof(T) == 4 ? "UInt32" : "UInt64";
    }
}

/// Calls use(T{}) with the scalar type of a name; false if there is none.
template<class Use>
bool with_vtk_type(std::string_view name, const Use& use) {
    const auto try_types = [&]<class... T>(T... zero) {
        return ((name == vtk_name<T>() && (use(zero), true)) || ...);
    };
    return try_types(double{}, float{}, std::int64_t{}, std::int32_t{}, std::int16_t{}, std::int8_t{},
                     std::uint64_t{}, std::uint32_t{}, std::uint16_t{}, std::uint8_t{});
}

/// VTK's number of a line, triangle or tetrahedron.
constexpr int vtk_simplex_type(int dimension) {
    return dimension == 1 ? 3 : dimension == 2 ? 5 : 10;
}

/// Dimension of a simplex type, -1 for any other: vertex, line, triangle, tetrahedron, or a curved one, whose
/// corners come first among its points.
constexpr int vtk_simplex_dimension(int type) {
    switch (type) {
    case 1:
        return 0;
    case 3:
    case 21: // quadratic
    case 35: // cubic
    case 68: // Lagrange
        return 1;
    case 5:
    case 22:
    case 34: // with a point in the middle
    case 69:
        return 2;
    case 10:
    case 24:
    case 71:
        return 3;
    default:
        return -1;
    }
}

constexpr bool vtk_is_curved(int type) {
    return type > 10 && vtk_simplex_dimension(type) > 0;
}

/// The user's name of a cell type that we refuse.
inline std::string vtk_type_name(int type) {
    switch (type) {
    case 1:
        return "vertex";
    case 3:
        return "line";
    case 4:
        return "polyline";
    case 5:
        return "triangle";
    case 6:
        return "triangle strip";
    case 7:
        return "polygon";
    case 8:
        return "pixel";
    case 9:
        return "quadrilateral";
    case 10:
        return "tetrahedron";
    case 11:
        return "voxel";
    case 12:
        return "hexahedron";
    case 13:
        return "wedge";
    case 14:
        return "pyramid";
    case 21:
        return "quadratic line";
    case 22:
        return "quadratic triangle";
    case 24:
        return "quadratic tetrahedron";
    case 42:
        return "polyhedron";
    default:
        return "cell of VTK's type " + std::to_string(type);
    }
}

} // namespace slabhull::io
