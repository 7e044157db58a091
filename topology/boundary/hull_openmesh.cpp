// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/hull_openmesh.h"

#include "topology/boundary/openmesh_build.h"

#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include <cstddef>

namespace slabhull {

HullOpenMesh to_openmesh(const Hull<2>& hull) {
    HullOpenMesh mesh;
    SoupDemands demands;
    demands.closed = true;
    fill_openmesh(mesh, hull.points, hull.cells, demands);

    auto ids = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, PersistentId>(mesh, vertex_id_property);
    auto tracks = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, TrackId>(mesh, track_id_property);
    for (const auto v : mesh.vertices()) {
        const auto number = static_cast<std::size_t>(v.idx());
        ids[v] = hull.vertex_ids[number];
        tracks[v] = hull.track_ids[number];
    }
    auto region = OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, Region>(mesh, region_property);
    auto patch = OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, PatchNumber>(mesh, patch_property);
    auto layer = OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, int>(mesh, layer_property);
    for (const auto f : mesh.faces()) {
        const auto cell = static_cast<std::size_t>(f.idx());
        region[f] = hull.region(cell);
        patch[f] = hull.patch(cell);
        layer[f] = hull.layer(cell);
    }
    return mesh;
}

} // namespace slabhull
