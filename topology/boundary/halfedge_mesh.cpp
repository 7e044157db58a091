// SPDX-License-Identifier: BSD-3-Clause
// OpenMesh's handles stay in this file: those of different kinds compare equal.
#include "slabhull/topology/halfedge_mesh.h"

#include "topology/complex/soup_manifold.h"

#include "slabhull/core/error.h"

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

namespace slabhull {

namespace {

/// Connectivity alone: places belong to the levels of a slab.
using OpenMeshSurface = OpenMesh::TriConnectivity;

template<class Handle, class Kind>
Handle handle(Id<Kind> id) {
    return Handle{static_cast<int>(id.slot())};
}
OpenMesh::VertexHandle handle_of(VertexId id) {
    return handle<OpenMesh::VertexHandle>(id);
}
OpenMesh::FaceHandle handle_of(FacetId id) {
    return handle<OpenMesh::FaceHandle>(id);
}
OpenMesh::HalfedgeHandle handle_of(HalfedgeId id) {
    return handle<OpenMesh::HalfedgeHandle>(id);
}

/// An invalid handle, -1, has the bits of an invalid id.
template<class IdType>
IdType id_of(OpenMesh::BaseHandle handle) {
    return IdType{static_cast<Index>(handle.idx())};
}
VertexId id_of(OpenMesh::VertexHandle handle) {
    return id_of<VertexId>(handle);
}
FacetId id_of(OpenMesh::FaceHandle handle) {
    return id_of<FacetId>(handle);
}
EdgeId id_of(OpenMesh::EdgeHandle handle) {
    return id_of<EdgeId>(handle);
}
HalfedgeId id_of(OpenMesh::HalfedgeHandle handle) {
    return id_of<HalfedgeId>(handle);
}

template<class Range>
auto ids_of(const Range& handles) {
    std::vector<decltype(id_of(*handles.begin()))> result;
    for (const auto h : handles) {
        result.push_back(id_of(h));
    }
    return result;
}

} // namespace

struct HalfedgeMesh::Mesh {
    OpenMeshSurface mesh;
};

HalfedgeMesh::HalfedgeMesh(std::span<const Facet<3>> triangles, std::size_t vertex_count,
                           const std::function<Entity(Index triangle)>& name)
    : mesh_{std::make_unique<Mesh>()} {
    manifold_adjacency<2>(triangles, vertex_count, {true, name}); // OpenMesh would leave triangles out
    OpenMeshSurface& mesh = mesh_->mesh;
    mesh.reserve(vertex_count, 3 * triangles.size() / 2, triangles.size());
    for (std::size_t v = 0; v < vertex_count; ++v) {
        mesh.new_vertex();
    }
    const auto vertex = [](Index v) { return handle_of(VertexId{v}); };
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const Facet<3>& t = triangles[f];
        // OpenMesh numbers new edges as they come: those opposite to corners 0, 1, 2.
        const auto face = mesh.add_face(vertex(t[1]), vertex(t[2]), vertex(t[0]));
        if (!face.is_valid()) {
            throw GeometryError{"a triangle was refused by OpenMesh", {name(static_cast<Index>(f))}};
        }
        // OpenMesh does not promise which half-edge of a face it keeps: the one that leads to corner 0.
        mesh.set_halfedge_handle(face, mesh.find_halfedge(vertex(t[2]), vertex(t[0])));
    }
}

HalfedgeMesh::~HalfedgeMesh() = default;
HalfedgeMesh::HalfedgeMesh(HalfedgeMesh&&) noexcept = default;
HalfedgeMesh& HalfedgeMesh::operator=(HalfedgeMesh&&) noexcept = default;

std::size_t HalfedgeMesh::vertex_count() const {
    return mesh_->mesh.n_vertices();
}
std::size_t HalfedgeMesh::edge_count() const {
    return mesh_->mesh.n_edges();
}
std::size_t HalfedgeMesh::facet_count() const {
    return mesh_->mesh.n_faces();
}

// --- from a half-edge

VertexId HalfedgeMesh::from(HalfedgeId h) const {
    return id_of(mesh_->mesh.from_vertex_handle(handle_of(h)));
}
VertexId HalfedgeMesh::to(HalfedgeId h) const {
    return id_of(mesh_->mesh.to_vertex_handle(handle_of(h)));
}
HalfedgeId HalfedgeMesh::opposite(HalfedgeId h) const {
    return id_of(mesh_->mesh.opposite_halfedge_handle(handle_of(h)));
}
HalfedgeId HalfedgeMesh::next(HalfedgeId h) const {
    return id_of(mesh_->mesh.next_halfedge_handle(handle_of(h)));
}
HalfedgeId HalfedgeMesh::previous(HalfedgeId h) const {
    return id_of(mesh_->mesh.prev_halfedge_handle(handle_of(h)));
}
FacetId HalfedgeMesh::facet(HalfedgeId h) const {
    return id_of(mesh_->mesh.face_handle(handle_of(h)));
}
EdgeId HalfedgeMesh::edge(HalfedgeId h) const {
    return id_of(mesh_->mesh.edge_handle(handle_of(h)));
}

// --- around a facet

std::array<HalfedgeId, 3> HalfedgeMesh::halfedges(FacetId facet) const {
    const HalfedgeId last = id_of(mesh_->mesh.halfedge_handle(handle_of(facet))); // as the constructor set it
    return {next(last), next(next(last)), last};
}

std::array<VertexId, 3> HalfedgeMesh::vertices(FacetId facet) const {
    const auto around = halfedges(facet);
    return {from(around[0]), from(around[1]), from(around[2])};
}

std::array<FacetId, 3> HalfedgeMesh::neighbors(FacetId facet) const {
    const auto around = halfedges(facet);
    const auto across = [this](HalfedgeId h) { return this->facet(opposite(h)); };
    return {across(around[1]), across(around[2]), across(around[0])};
}

// --- at an edge

std::array<HalfedgeId, 2> HalfedgeMesh::halfedges(EdgeId edge) const {
    return {HalfedgeId{2 * edge.slot()}, HalfedgeId{2 * edge.slot() + 1}};
}

std::array<VertexId, 2> HalfedgeMesh::vertices(EdgeId edge) const {
    const auto sides = halfedges(edge);
    return {from(sides[0]), to(sides[0])};
}

std::array<FacetId, 2> HalfedgeMesh::facets(EdgeId edge) const {
    const auto sides = halfedges(edge);
    return {facet(sides[0]), facet(sides[1])};
}

// --- around a vertex

std::vector<HalfedgeId> HalfedgeMesh::outgoing(VertexId vertex) const {
    return ids_of(mesh_->mesh.voh_range(handle_of(vertex)));
}

std::vector<VertexId> HalfedgeMesh::neighbors(VertexId vertex) const {
    return ids_of(mesh_->mesh.vv_range(handle_of(vertex)));
}

std::vector<FacetId> HalfedgeMesh::facets(VertexId vertex) const {
    return ids_of(mesh_->mesh.vf_range(handle_of(vertex)));
}

HalfedgeId HalfedgeMesh::halfedge(VertexId from, VertexId to) const {
    return id_of(mesh_->mesh.find_halfedge(handle_of(from), handle_of(to)));
}

} // namespace slabhull
