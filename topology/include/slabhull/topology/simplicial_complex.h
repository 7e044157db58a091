// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"
#include "slabhull/core/point.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/id_range.h"
#include "slabhull/topology/spatial_mesh.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <ranges>
#include <span>
#include <vector>

namespace slabhull {

/// A facet seen from one of its cells: facet `place` of `cell`, the one opposite to vertex `place`. One
/// 64-bit number, cell * (D + 1) + place. A facet inside has two half-facets, mirrors of each other; one on
/// the boundary has one.
template<int D>
class HalfFacetId {
public:
    constexpr HalfFacetId() = default;
    constexpr HalfFacetId(CellId cell, std::size_t place)
        : number_{std::uint64_t{cell.slot()} * (D + 1) + place} {}
    constexpr explicit HalfFacetId(std::uint64_t number) : number_{number} {}

    constexpr bool valid() const { return number_ != none; }
    constexpr std::uint64_t number() const { return number_; }
    constexpr CellId cell() const {
        return valid() ? CellId{static_cast<Index>(number_ / (D + 1))} : CellId{};
    }
    constexpr std::size_t place() const { return static_cast<std::size_t>(number_ % (D + 1)); }
    friend constexpr auto operator<=>(HalfFacetId, HalfFacetId) = default;

private:
    static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t number_ = none;
};

/// An oriented manifold of D-simplices (D = 1, 2, 3), with or without boundary, to be walked in.
///
/// It keeps, in 4-byte indices, the vertices of the cells and the cells across their facets, both either its
/// own or somebody else's (a view), and one cell of each vertex. A tetrahedron costs 16 + 16 bytes, or
/// nothing in a view, and its share of a vertex's cell, some 0.7 bytes.
///
/// The order of vertices in a cell is its orientation: neighbours induce opposite ones on the facet that they
/// share. Queries about one cell take constant time, those about a vertex or an edge are linear in the star
/// of the vertex. No walk is longer than the mesh is large, whatever a view's neighbours say. Queries may run
/// in several threads.
template<int D>
class SimplicialComplex {
    static_assert(D >= 1 && D <= 3);

public:
    using HalfFacet = HalfFacetId<D>;
    static constexpr std::size_t corners = D + 1;
    static constexpr std::size_t edges_per_cell = D * (D + 1) / 2;

    /// The complex of a soup of cells. Vertices that no cell uses are allowed.
    /// Throws GeometryError, with the cells as entities, if this is not an oriented manifold: cells that
    /// name a vertex twice or one that does not exist, doubles, facets in three or more cells or in two that
    /// disagree in orientation, vertices whose link is not a sphere or a disc. Nothing is mended.
    /// Cost: near-linear, that of build_adjacency() and a walk around every vertex.
    static SimplicialComplex from_soup(Array<Simplex<D>> cells, std::size_t vertex_count);

    /// A view of arrays that must outlive it and describe an oriented manifold, as those of a hull or a
    /// spatial mesh.
    /// Throws GeometryError for arrays of different lengths and indices out of range, so that no query leaves
    /// them; the rest is taken on trust. Cost: one pass, 4 bytes per vertex.
    static SimplicialComplex view(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors,
                                  std::size_t vertex_count);

    /// The same, but the complex owns the arrays.
    static SimplicialComplex adopt(Array<Simplex<D>> cells, Array<Neighbors<D>> neighbors,
                                   std::size_t vertex_count);

    SimplicialComplex(SimplicialComplex&&) noexcept = default;
    SimplicialComplex& operator=(SimplicialComplex&&) noexcept = default;

    // --- elements

    std::size_t vertex_count() const { return cell_of_.size(); }
    std::size_t cell_count() const { return cells_.size(); }
    auto vertices() const { return id_range<VertexId>(vertex_count()); }
    auto cells() const { return id_range<CellId>(cell_count()); }
    /// All half-facets, by cell.
    auto half_facets() const {
        return std::views::iota(std::uint64_t{0}, std::uint64_t{cell_count()} * corners) |
               std::views::transform([](std::uint64_t number) { return HalfFacet{number}; });
    }
    /// The half-facets that have no mirror.
    auto boundary_facets() const {
        return half_facets() | std::views::filter([this](HalfFacet h) { return !across(h).valid(); });
    }
    bool closed() const { return boundary_facets().empty(); }

    // --- in and around a cell

    std::array<VertexId, corners> vertices(CellId cell) const;
    /// The edges of a cell, each from the vertex that comes first in the cell.
    std::array<std::array<VertexId, 2>, edges_per_cell> edges(CellId cell) const;
    std::array<HalfFacet, corners> half_facets(CellId cell) const;
    bool has(CellId cell, VertexId vertex) const;

    // --- across a facet

    /// The cell on the other side; invalid on the boundary.
    CellId across(HalfFacet h) const { return CellId{neighbors_[h.cell().slot()][h.place()]}; }
    /// The same facet seen from the other side; invalid on the boundary.
    HalfFacet mirror(HalfFacet h) const;
    /// The vertex of its cell that a half-facet is opposite to.
    VertexId apex(HalfFacet h) const { return VertexId{cells_[h.cell().slot()][h.place()]}; }
    /// In the order of outward_facet(): that of the facet as part of the boundary of its cell.
    std::array<VertexId, D> vertices(HalfFacet h) const;

    // --- around a vertex

    /// A cell of the vertex, the first one; invalid when no cell uses it.
    CellId cell_of(VertexId vertex) const { return CellId{cell_of_[vertex.slot()]}; }
    /// The cells at a vertex; for D = 2 in cyclic order, anticlockwise where cells are, and from boundary to
    /// boundary.
    std::vector<CellId> star(VertexId vertex) const;
    /// The facets of the star's cells opposite to the vertex, in the order of the star: a sphere or a disc.
    std::vector<HalfFacet> link(VertexId vertex) const;
    /// The vertices that an edge joins it to, in the order of the star.
    std::vector<VertexId> neighbors(VertexId vertex) const;

    // --- around an edge; empty when there is no edge from a to b

    /// The cells at an edge; for D = 3 in cyclic order, from boundary to boundary.
    std::vector<CellId> star(VertexId a, VertexId b) const;
    /// The vertices that make the edge a triangle. For D = 3 they are in cyclic order, such that cell k of
    /// the star has the vertices a, b, link[k], link[k + 1] in its orientation; the last cell of a closed
    /// star has link[0] again.
    std::vector<VertexId> link(VertexId a, VertexId b) const;

    // --- arrays for bulk work

    std::span<const Simplex<D>> cell_array() const { return cells_; }
    std::span<const Neighbors<D>> neighbor_array() const { return neighbors_; }

private:
    SimplicialComplex(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors,
                      std::size_t vertex_count);

    Array<Simplex<D>> own_cells_; ///< empty in a view
    Array<Neighbors<D>> own_neighbors_;
    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    Array<Index> cell_of_; ///< of each vertex the first cell
};

extern template class SimplicialComplex<1>;
extern template class SimplicialComplex<2>;
extern template class SimplicialComplex<3>;

/// Views of a hull and of a spatial mesh, which must outlive them. Nothing is copied.
template<int D>
SimplicialComplex<D> view_of(const Hull<D>& hull) {
    return SimplicialComplex<D>::view(hull.cells, hull.neighbors, hull.points.size());
}
template<int D>
SimplicialComplex<D> view_of(const SpatialMesh<D>& mesh) {
    return SimplicialComplex<D>::view(mesh.cells, mesh.neighbors, mesh.points.size());
}
template<int D>
SimplicialComplex<D> view_of(const Hull<D>&& hull) = delete;
template<int D>
SimplicialComplex<D> view_of(const SpatialMesh<D>&& mesh) = delete;

/// Part of a complex as a complex of its own, and where its elements come from.
template<int D, class Origin>
struct PartOfComplex {
    SimplicialComplex<D> complex;
    std::vector<VertexId> vertices; ///< of the whole, ascending, one for each vertex of the part
    std::vector<Origin> cells;      ///< of the whole, one for each cell of the part
};

/// The cells chosen, each once, with their own vertices.
/// Throws GeometryError when they are no manifold, as cells that touch in a vertex only.
template<int D>
PartOfComplex<D, CellId> part_of(const SimplicialComplex<D>& whole, std::span<const CellId> chosen);

/// The boundary (D = 2, 3), oriented as outward_facet() does, with its own vertices. Its
/// adjacency is found by turning about the ridges of the boundary, through the cells inside.
template<int D>
PartOfComplex<D - 1, HalfFacetId<D>> boundary_of(const SimplicialComplex<D>& whole);

/// The components of a 1-complex as chains of vertices, each from its first vertex on in the sense of the
/// edges. A closed loop names no vertex twice; an open chain ends with its last vertex.
std::vector<std::vector<VertexId>> loops(const SimplicialComplex<1>& curve);

/// The loops of boundary edges of a 2-complex, in its own vertices; the cells are to the right.
std::vector<std::vector<VertexId>> boundary_loops(const SimplicialComplex<2>& surface);

} // namespace slabhull
