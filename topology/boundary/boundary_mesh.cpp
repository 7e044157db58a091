// SPDX-License-Identifier: BSD-3-Clause
// OpenMesh's handles stay in this file: those of different kinds compare equal.
#include "slabhull/topology/boundary_mesh.h"

#include "topology/boundary/openmesh_build.h"

#include "slabhull/core/error.h"

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <ranges>

namespace slabhull {

namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

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

void require_length(std::size_t given, std::size_t wanted, const char* what) {
    if (given != 0 && given != wanted) {
        throw UsageError{fmt::format("{} {} were given for {} vertices", given, what, wanted)};
    }
}

} // namespace

struct BoundaryMesh::Mesh {
    explicit Mesh(const PatchList& list) : patches{list} {
        mesh.add_property(ids, "vertex_id");
        mesh.add_property(tracks, "track_id");
        mesh.add_property(patch, "patch");
    }

    HalfEdgeMesh mesh;
    OpenMesh::VPropHandleT<PersistentId> ids;
    OpenMesh::VPropHandleT<TrackId> tracks;
    OpenMesh::FPropHandleT<PatchNumber> patch;
    PatchList patches;
};

BoundaryMesh::BoundaryMesh(const Surface<3>& surface, std::span<const PersistentId> vertex_ids,
                           std::span<const TrackId> track_ids)
    : mesh_{std::make_unique<Mesh>(surface.patches)} {
    require_length(vertex_ids.size(), surface.points.size(), "ids");
    require_length(track_ids.size(), surface.points.size(), "tracks");
    SoupDemands demands{
        true, [&surface](Index facet) {
            const bool known = facet < surface.patch.size();
            return Entity{"facet", facet, known ? patch_name(surface.patches, surface.patch[facet]) : ""};
        }};
    fill_openmesh(mesh_->mesh, surface.points, surface.facets, demands);
    if (vertex_ids.empty()) {
        std::iota(persistent_ids().begin(), persistent_ids().end(), PersistentId{0});
    }
    std::ranges::copy(vertex_ids, persistent_ids().begin());
    std::ranges::fill(tracks(), no_track);
    std::ranges::copy(track_ids, tracks().begin());
    std::ranges::fill(facet_patches(), PatchNumber{0});
    std::ranges::copy(surface.patch | std::views::take(surface.facets.size()), facet_patches().begin());
}

BoundaryMesh::~BoundaryMesh() = default;
BoundaryMesh::BoundaryMesh(BoundaryMesh&&) noexcept = default;
BoundaryMesh& BoundaryMesh::operator=(BoundaryMesh&&) noexcept = default;

std::size_t BoundaryMesh::vertex_count() const {
    return mesh_->mesh.n_vertices();
}
std::size_t BoundaryMesh::edge_count() const {
    return mesh_->mesh.n_edges();
}
std::size_t BoundaryMesh::facet_count() const {
    return mesh_->mesh.n_faces();
}

// --- from a half-edge

VertexId BoundaryMesh::from(HalfedgeId h) const {
    return id_of(mesh_->mesh.from_vertex_handle(handle_of(h)));
}
VertexId BoundaryMesh::to(HalfedgeId h) const {
    return id_of(mesh_->mesh.to_vertex_handle(handle_of(h)));
}
HalfedgeId BoundaryMesh::opposite(HalfedgeId h) const {
    return id_of(mesh_->mesh.opposite_halfedge_handle(handle_of(h)));
}
HalfedgeId BoundaryMesh::next(HalfedgeId h) const {
    return id_of(mesh_->mesh.next_halfedge_handle(handle_of(h)));
}
HalfedgeId BoundaryMesh::previous(HalfedgeId h) const {
    return id_of(mesh_->mesh.prev_halfedge_handle(handle_of(h)));
}
FacetId BoundaryMesh::facet(HalfedgeId h) const {
    return id_of(mesh_->mesh.face_handle(handle_of(h)));
}
EdgeId BoundaryMesh::edge(HalfedgeId h) const {
    return id_of(mesh_->mesh.edge_handle(handle_of(h)));
}

// --- around a facet

std::array<HalfedgeId, 3> BoundaryMesh::halfedges(FacetId facet) const {
    const HalfedgeId last = id_of(mesh_->mesh.halfedge_handle(handle_of(facet))); // see fill_openmesh()
    return {next(last), next(next(last)), last};
}

std::array<VertexId, 3> BoundaryMesh::vertices(FacetId facet) const {
    const auto around = halfedges(facet);
    return {from(around[0]), from(around[1]), from(around[2])};
}

std::array<FacetId, 3> BoundaryMesh::neighbors(FacetId facet) const {
    const auto around = halfedges(facet);
    const auto across = [this](HalfedgeId h) { return this->facet(opposite(h)); };
    return {across(around[1]), across(around[2]), across(around[0])};
}

// --- at an edge

std::array<HalfedgeId, 2> BoundaryMesh::halfedges(EdgeId edge) const {
    return {HalfedgeId{2 * edge.slot()}, HalfedgeId{2 * edge.slot() + 1}};
}

std::array<VertexId, 2> BoundaryMesh::vertices(EdgeId edge) const {
    const auto sides = halfedges(edge);
    return {from(sides[0]), to(sides[0])};
}

std::array<FacetId, 2> BoundaryMesh::facets(EdgeId edge) const {
    const auto sides = halfedges(edge);
    return {facet(sides[0]), facet(sides[1])};
}

// --- around a vertex

std::vector<HalfedgeId> BoundaryMesh::outgoing(VertexId vertex) const {
    return ids_of(mesh_->mesh.voh_range(handle_of(vertex)));
}

std::vector<VertexId> BoundaryMesh::neighbors(VertexId vertex) const {
    return ids_of(mesh_->mesh.vv_range(handle_of(vertex)));
}

std::vector<FacetId> BoundaryMesh::facets(VertexId vertex) const {
    return ids_of(mesh_->mesh.vf_range(handle_of(vertex)));
}

HalfedgeId BoundaryMesh::halfedge(VertexId from, VertexId to) const {
    return id_of(mesh_->mesh.find_halfedge(handle_of(from), handle_of(to)));
}

// --- properties

Point<3> BoundaryMesh::point(VertexId vertex) const {
    const auto& p = mesh_->mesh.point(handle_of(vertex));
    return {p[0], p[1], p[2]};
}

void BoundaryMesh::move(VertexId vertex, const Point<3>& place) {
    mesh_->mesh.set_point(handle_of(vertex), {place[0], place[1], place[2]});
}

std::span<const PersistentId> BoundaryMesh::persistent_ids() const {
    return mesh_->mesh.property(mesh_->ids).data_vector();
}
std::span<PersistentId> BoundaryMesh::persistent_ids() {
    return mesh_->mesh.property(mesh_->ids).data_vector();
}
std::span<const TrackId> BoundaryMesh::tracks() const {
    return mesh_->mesh.property(mesh_->tracks).data_vector();
}
std::span<TrackId> BoundaryMesh::tracks() {
    return mesh_->mesh.property(mesh_->tracks).data_vector();
}
std::span<const PatchNumber> BoundaryMesh::facet_patches() const {
    return mesh_->mesh.property(mesh_->patch).data_vector();
}
std::span<PatchNumber> BoundaryMesh::facet_patches() {
    return mesh_->mesh.property(mesh_->patch).data_vector();
}
const PatchList& BoundaryMesh::patches() const {
    return mesh_->patches;
}

// --- patches

bool BoundaryMesh::on_patch_border(EdgeId edge) const {
    const auto sides = facets(edge);
    return patch(sides[0]) != patch(sides[1]);
}

std::vector<EdgeId> BoundaryMesh::patch_border() const {
    std::vector<EdgeId> result;
    std::ranges::copy_if(edges(), std::back_inserter(result),
                         [this](EdgeId e) { return on_patch_border(e); });
    return result;
}

std::vector<std::vector<HalfedgeId>> BoundaryMesh::patch_loops(PatchNumber number) const {
    const auto on_border = [&](HalfedgeId h) {
        return patch(facet(h)) == number && patch(facet(opposite(h))) != number;
    };
    std::vector<char> met(2 * edge_count(), 0);
    std::vector<std::vector<HalfedgeId>> loops;
    for (const HalfedgeId start : halfedges()) {
        if (met[start.slot()] != 0 || !on_border(start)) {
            continue;
        }
        std::vector<HalfedgeId>& loop = loops.emplace_back();
        for (HalfedgeId h = start; met[h.slot()] == 0;) {
            met[h.slot()] = 1;
            loop.push_back(h);
            h = next(h);
            while (!on_border(h)) { // turn about the vertex, through facets of the patch
                h = next(opposite(h));
            }
        }
    }
    return loops;
}

} // namespace slabhull
