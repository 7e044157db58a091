// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/facet_components.h"
#include "slabhull/topology/spatial_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace slabhull {

class HalfedgeMesh;
template<int D>
class SimplicialComplex;

/// A facet across a ridge, and its corner opposite to that ridge.
struct TwinFacet {
    Index facet;
    std::uint8_t corner;
};

/// The boundary of a moving domain: a closed oriented (D-1)-manifold of facets, whose connectivity stays
/// while its vertices move. It is opened once, when a march starts, and everyone who needs to know which
/// facet is beside what asks it: half-edges (OpenMesh) for D = 3, a complex of edges for D = 2.
///
/// Two facets meet in a ridge: an edge for D = 3, a vertex for D = 2. Ridge i of a facet is opposite to its
/// vertex i. Ridges are numbered by the first facet that has them, then by i (D = 3); for D = 2 they have the
/// numbers of their vertices.
///
/// Copies are cheap: they share the connectivity. Queries run in several threads.
template<int D>
class Boundary {
public:
    /// The connectivity in the terms of the dimension; who asks it includes its header.
    using Mesh = std::conditional_t<D == 3, HalfedgeMesh, SimplicialComplex<1>>;

    /// No boundary; only good to be assigned to.
    Boundary() = default;

    /// Opens a surface at its present places. `tracks` are of its vertices, by default no_track for all;
    /// facets without patches have patch 0. `spacing`: see spacing().
    /// Throws GeometryError naming the facets, with their patches, when the surface is no closed oriented
    /// manifold, and UsageError for tracks, patches or spacings of another number. Cost: near-linear.
    explicit Boundary(Surface<D> surface, Array<TrackId> tracks = {}, Array<double> spacing = {});

    // --- facets and vertices, in the order of the surface that was opened

    std::size_t vertex_count() const { return data().surface.points.size(); }
    std::size_t facet_count() const { return data().surface.facets.size(); }
    std::span<const Facet<D>> facets() const { return data().surface.facets; }
    /// The places at which it was opened: where the motion starts.
    std::span<const Point<D>> start() const { return data().surface.points; }
    /// The surface as it was opened.
    const Surface<D>& start_surface() const { return data().surface; }
    /// The surface with its vertices at `places`.
    Surface<D> at(Array<Point<D>> places) const;

    // --- what is beside what

    const Mesh& mesh() const { return *data().mesh; }
    /// The facet across each ridge of a facet. A view that DualGraph<D - 1> and the matching take.
    std::span<const Neighbors<D - 1>> neighbors() const { return data().neighbors; }
    TwinFacet twin(std::size_t facet, std::size_t ridge) const {
        return {data().neighbors[facet][ridge], data().twin_corner[facet][ridge]};
    }
    /// Which facets are connected.
    const FacetComponents<D>& facet_components() const { return data().components; }
    std::size_t ridge_count() const { return data().ridges; }
    /// Of the facets beside a ridge, the first one counts as its owner.
    bool owns(std::size_t facet, std::size_t ridge) const { return facet < neighbors()[facet][ridge]; }
    /// Length of the shortest facet edge at each vertex; `places` are those of the vertices.
    std::vector<double> shortest_edges(std::span<const Point<D>> places) const;
    /// Mean length of the facet edges at each vertex.
    std::vector<double> mean_edges(std::span<const Point<D>> places) const;

    // --- properties

    std::span<const TrackId> tracks() const { return data().tracks; }           ///< of the vertices
    std::span<const PatchNumber> patch() const { return data().surface.patch; } ///< of the facets
    const PatchList& patches() const { return data().surface.patches; }
    /// Length that edges at each vertex are meant to have, of a boundary whose connectivity was adapted; else
    /// empty.
    std::span<const double> spacing() const { return data().spacing; }
    /// The vertices of some patches, ascending.
    std::vector<Index> vertices_of(const std::vector<PatchNumber>& patches) const;
    /// Whether a ridge lies between facets of different patches.
    bool on_crease(std::size_t facet, std::size_t ridge) const {
        return patch()[facet] != patch()[neighbors()[facet][ridge]];
    }
    /// The rim of a patch as loops of vertices, each with the patch on its left, ordered by their first
    /// half-edge (D = 3). Where several loops pass through a vertex, each keeps to the facets that it goes
    /// around.
    std::vector<std::vector<Index>> patch_loops(PatchNumber patch) const requires(D == 3);

    // --- the spatial mesh that it bounds at present

    /// The mesh's vertex that each vertex of the boundary is.
    std::span<const Index> mesh_vertices() const { return mesh_vertices_; }
    /// Persistent ids of the vertices in that mesh.
    std::span<const PersistentId> persistent_ids() const { return ids_; }
    /// The same boundary, bounding another mesh: one whose first vertices are those of the boundary, unless
    /// `mesh_vertices` says which they are. `ids` are those of all vertices of the mesh; none are taken where
    /// there are none. Throws UsageError for vertices that the mesh does not have.
    Boundary bounding(std::span<const PersistentId> ids, Array<Index> mesh_vertices = {}) const;

private:
    struct Data {
        Surface<D> surface; ///< at the start
        Array<TrackId> tracks;
        Array<double> spacing;
        std::unique_ptr<const Mesh> mesh;
        Array<Neighbors<D - 1>> neighbors;
        Array<std::array<std::uint8_t, D>> twin_corner;
        std::size_t ridges = 0;
        FacetComponents<D> components;
    };
    const Data& data() const { return *data_; }
    static void connect(Data& data);

    std::shared_ptr<const Data> data_;
    Array<Index> mesh_vertices_;
    Array<PersistentId> ids_;
};

/// The boundary facets of a mesh as a surface of its own. Vertices in the order of the mesh's;
/// `mesh_vertices` receives the mesh's vertex for each.
template<int D>
Surface<D> boundary_surface(const SpatialMesh<D>& mesh, Array<Index>& mesh_vertices);

/// Opens the boundary of a mesh, with its patches, and its tracks and ids where it has them. Vertices in the
/// order of the mesh's. Throws as Boundary() does.
template<int D>
Boundary<D> boundary_of(const SpatialMesh<D>& mesh);

extern template class Boundary<2>;
extern template class Boundary<3>;

} // namespace slabhull
