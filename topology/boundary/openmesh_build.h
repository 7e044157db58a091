// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "topology/complex/soup_manifold.h"

#include "slabhull/core/point.h"

#include <OpenMesh/Core/Mesh/Handles.hh>

#include <cstddef>
#include <span>

namespace slabhull {

/// Fills an empty OpenMesh triangle mesh; its vertices and faces get the numbers that they have here. Each
/// face's half-edge leads to its first vertex. Throws GeometryError when the triangles are not as demanded:
/// OpenMesh prints a line and leaves the triangle out.
template<class Mesh>
void fill_openmesh(Mesh& mesh, std::span<const Point<3>> points, std::span<const Simplex<2>> triangles,
                   const SoupDemands& demands) {
    manifold_adjacency<2>(triangles, points.size(), demands);
    mesh.reserve(points.size(), 3 * triangles.size() / 2, triangles.size());
    for (const Point<3>& p : points) {
        mesh.add_vertex(typename Mesh::Point{p[0], p[1], p[2]});
    }
    const auto vertex = [](Index v) { return OpenMesh::VertexHandle{static_cast<int>(v)}; };
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const Simplex<2>& t = triangles[f];
        const auto face = mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
        if (!face.is_valid()) {
            throw GeometryError{"a triangle was refused by OpenMesh", {demands.name(static_cast<Index>(f))}};
        }
        // OpenMesh does not promise which half-edge of a face it keeps.
        mesh.set_halfedge_handle(face, mesh.find_halfedge(vertex(t[2]), vertex(t[0])));
    }
}

} // namespace slabhull
