// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "specimens.h"

#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

/// Domains for the meshers of 3D caps.
namespace slabhull::specimens {

inline Surface<3> with_bodies(Surface<3> outer, const std::vector<Surface<3>>& bodies) {
    for (const Surface<3>& body : bodies) {
        outer = together(std::move(outer), turned_inside_out(body));
    }
    return outer;
}

inline Surface<3> cube(double half_edge, Index n) {
    return box({-half_edge, -half_edge, -half_edge}, {half_edge, half_edge, half_edge}, n);
}

inline double enclosed(const Surface<3>& surface) {
    double sum = 0;
    for (const Facet<3>& f : surface.facets) {
        sum +=
            signed_measure<3>({Point<3>{}, surface.points[f[0]], surface.points[f[1]], surface.points[f[2]]});
    }
    return sum;
}

inline double volume(const CapMesh<3>& mesh) {
    double sum = 0;
    for (const Simplex<3>& cell : mesh.cells) {
        sum += signed_measure<3>(corners_of<3, 3>(cell, mesh.points));
    }
    return sum;
}

inline double smallest_dihedral(const CapMesh<3>& mesh) {
    double smallest = 180;
    for (const Simplex<3>& cell : mesh.cells) {
        smallest = std::min(smallest, dihedral_angles<3, 3>(corners_of<3, 3>(cell, mesh.points)).smallest);
    }
    return smallest;
}

struct Room {
    std::string name;
    Surface<3> boundary;
};

inline std::vector<Room> rooms() {
    const auto flat = [](Point<3> p) { return Point<3>{0.3 * p[0], 3 * p[1], p[2]}; };
    return {
        {"a cube without a body", cube(1, 3)},
        {"a ball", ball({1, 2, 3}, 0.5, 6)},
        {"a sphere in a cube", with_bodies(cube(5, 8), {ball({0, 0, 0}, 1, 6)})},
        {"a ring in a cube", with_bodies(cube(5, 6), {torus(2, 0.7, 24, 12)})},
        {"two bodies", with_bodies(cube(5, 6), {ball({-2.5, 0, 0}, 1, 5), torus(1, 0.3, 20, 8)})},
        {"two linked rings",
         with_bodies(cube(5, 6), {torus(2, 0.4, 24, 10), mapped(torus(2, 0.4, 24, 10),
                                                                [](Point<3> p) {
                                                                    return Point<3>{p[0] + 2, -p[2], p[1]};
                                                                })})},
        {"an ellipsoid of axes 1 to 10", with_bodies(cube(5, 6), {mapped(ball({0, 0, 0}, 1, 8), flat)})},
        {"a thin gap", with_bodies(cube(1, 12), {ball({0, 0, 0.499}, 0.5, 12)})},
        {"a shell around a ball of fluid inside a hollow body",
         together(with_bodies(cube(5, 6), {ball({0, 0, 0}, 2, 6)}), ball({0, 0, 0}, 1, 5))},
        {"a torus filled", torus(2, 0.7, 24, 12)},
    };
}

inline Room small_room() {
    return {"", with_bodies(cube(2, 4), {ball({0, 0, 0}, 1, 3)})};
}

} // namespace slabhull::specimens
