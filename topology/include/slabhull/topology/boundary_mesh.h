// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/id_range.h"
#include "slabhull/topology/spatial_mesh.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace slabhull {

using EdgeId = Id<struct EdgeKind>;
using HalfedgeId = Id<struct HalfedgeKind>;

/// The boundary of a domain in space as a half-edge mesh (OpenMesh, behind ids that cannot be mixed up), with
/// persistent ids, tracks and patches as properties. Vertices and facets have the numbers that they have in
/// the surface.
///
///          to                 A half-edge goes along its facet in the facet's sense, so outward normals have
///          the facet ^ \                on the left. Edge k has the half-edges 2k and 2k + 1.
///      h  |   \  next(h)
///         |    v
///        from <--
///
/// For D = 2 a boundary is a set of closed polygons, and nothing is gained by half-edges:
/// SimplicialComplex<1> has the edges around a vertex, the edge across it, and loops(). The hull of D = 2 is
/// a triangulated surface; hull_openmesh.h opens it. Queries take constant time, or time linear in what they
/// return.
class BoundaryMesh {
public:
    /// Opens a closed surface. `vertex_ids` and `track_ids` are of its vertices; without them ids are the
    /// vertices' numbers, and tracks are all `no_track`. Throws GeometryError naming the facets, with their
    /// patches, when the surface is no closed oriented manifold (OpenMesh would silently leave facets out),
    /// and UsageError for properties of another length.
    explicit BoundaryMesh(const Surface<3>& surface, std::span<const PersistentId> vertex_ids = {},
                          std::span<const TrackId> track_ids = {});
    ~BoundaryMesh();
    BoundaryMesh(BoundaryMesh&&) noexcept;
    BoundaryMesh& operator=(BoundaryMesh&&) noexcept;

    // --- elements

    std::size_t vertex_count() const;
    std::size_t edge_count() const;
    std::size_t facet_count() const;
    auto vertices() const { return id_range<VertexId>(vertex_count()); }
    auto edges() const { return id_range<EdgeId>(edge_count()); }
    auto halfedges() const { return id_range<HalfedgeId>(2 * edge_count()); }
    auto facets() const { return id_range<FacetId>(facet_count()); }

    // --- from a half-edge

    VertexId from(HalfedgeId h) const;
    VertexId to(HalfedgeId h) const;
    HalfedgeId opposite(HalfedgeId h) const;
    HalfedgeId next(HalfedgeId h) const;     ///< in its facet
    HalfedgeId previous(HalfedgeId h) const; ///< in its facet
    FacetId facet(HalfedgeId h) const;
    EdgeId edge(HalfedgeId h) const;

    // --- around a facet, from its first vertex

    std::array<VertexId, 3> vertices(FacetId facet) const;
    std::array<HalfedgeId, 3> halfedges(FacetId facet) const; ///< the first leaves the first vertex
    std::array<FacetId, 3> neighbors(FacetId facet) const;    ///< neighbour i is opposite to vertex i

    // --- at an edge

    std::array<HalfedgeId, 2> halfedges(EdgeId edge) const;
    std::array<VertexId, 2>
    vertices(EdgeId edge) const; ///< those that its first half-edge comes from and goes to
    std::array<FacetId, 2> facets(EdgeId edge) const; ///< those of its two half-edges

    // --- around a vertex, clockwise seen from outside; nothing around one in no facet

    std::vector<HalfedgeId> outgoing(VertexId vertex) const;
    std::vector<VertexId> neighbors(VertexId vertex) const;
    std::vector<FacetId> facets(VertexId vertex) const;
    /// The half-edge between two vertices, or an invalid one.
    HalfedgeId halfedge(VertexId from, VertexId to) const;

    // --- properties

    Point<3> point(VertexId vertex) const;
    void move(VertexId vertex, const Point<3>& place);
    PersistentId persistent_id(VertexId vertex) const { return persistent_ids()[vertex.slot()]; }
    TrackId track(VertexId vertex) const { return tracks()[vertex.slot()]; }
    PatchNumber patch(FacetId facet) const { return facet_patches()[facet.slot()]; }
    /// All of them, in the order of the ids.
    std::span<const PersistentId> persistent_ids() const;
    std::span<PersistentId> persistent_ids();
    std::span<const TrackId> tracks() const;
    std::span<TrackId> tracks();
    std::span<const PatchNumber> facet_patches() const;
    std::span<PatchNumber> facet_patches();
    const PatchList& patches() const;

    // --- patches

    /// Whether the edge lies between facets of different patches.
    bool on_patch_border(EdgeId edge) const;
    std::vector<EdgeId> patch_border() const;
    /// The border of a patch as loops, each half-edge with the patch on its left, ordered by their least
    /// half-edge. Where several loops pass through a vertex, each keeps to the facets that it goes around.
    std::vector<std::vector<HalfedgeId>> patch_loops(PatchNumber patch) const;

private:
    struct Mesh;
    std::unique_ptr<Mesh> mesh_;
};

} // namespace slabhull
