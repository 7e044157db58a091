// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/index.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/id_range.h"

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace slabhull {

using EdgeId = Id<struct EdgeKind>;
using HalfedgeId = Id<struct HalfedgeKind>;

/// The half-edges of a closed oriented triangle surface: OpenMesh, behind ids that cannot be mixed up.
/// Vertices and facets have the numbers that they have in the list of triangles. Edges are numbered by the
/// first facet that has them, then by the corner of that facet which they are opposite to.
///
///          to                 A half-edge goes along its facet in the facet's sense, so outward normals have
///          the facet ^ \                on the left. Edge k has the half-edges 2k and 2k + 1.
///      h  |   \  next(h)
///         |    v
///        from <--
///
/// Queries take constant time, or time linear in what they return.
class HalfedgeMesh {
public:
    /// Throws GeometryError naming the triangles, by `name`, when they are no closed oriented manifold.
    HalfedgeMesh(std::span<const Facet<3>> triangles, std::size_t vertex_count,
                 const std::function<Entity(Index triangle)>& name);
    ~HalfedgeMesh();
    HalfedgeMesh(HalfedgeMesh&&) noexcept;
    HalfedgeMesh& operator=(HalfedgeMesh&&) noexcept;

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
    /// The vertices that the edge's first half-edge comes from and goes to.
    std::array<VertexId, 2> vertices(EdgeId edge) const;
    std::array<FacetId, 2> facets(EdgeId edge) const; ///< those of its two half-edges

    // --- around a vertex, clockwise seen from outside; nothing around one in no facet

    std::vector<HalfedgeId> outgoing(VertexId vertex) const;
    std::vector<VertexId> neighbors(VertexId vertex) const;
    std::vector<FacetId> facets(VertexId vertex) const;
    /// The half-edge between two vertices, or an invalid one.
    HalfedgeId halfedge(VertexId from, VertexId to) const;

private:
    struct Mesh;
    std::unique_ptr<Mesh> mesh_;
};

} // namespace slabhull
