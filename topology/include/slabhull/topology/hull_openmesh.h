// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The hulls of plane domains as OpenMesh meshes, for users who want half-edges on them. This is the one
/// header that includes OpenMesh: whoever uses it links OpenMeshCore.

#include "slabhull/topology/hull.h"

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace slabhull {

/// Points are (x, y, t).
using HullOpenMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

/// Names of the properties, those of the hull's arrays in files. Of vertices:
inline constexpr const char* vertex_id_property = "vertex_id"; ///< PersistentId
inline constexpr const char* track_id_property = "track_id";   ///< TrackId
/// Of faces:
inline constexpr const char* region_property = "region"; ///< Region
inline constexpr const char* patch_property = "patch";   ///< PatchNumber
inline constexpr const char* layer_property = "layer";   ///< int

/// A copy of the hull as a half-edge mesh: vertices and faces have the numbers of the hull's points and
/// cells. For example OpenMesh::getProperty<OpenMesh::FaceHandle, Region>(mesh, region_property)[face] is a
/// face's region. Throws GeometryError naming the cells when the hull is no closed oriented manifold. Cost:
/// linear; OpenMesh takes some 150 bytes per triangle.
HullOpenMesh to_openmesh(const Hull<2>& hull);

} // namespace slabhull
