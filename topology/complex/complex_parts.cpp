// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/simplicial_complex.h"

#include "core/used_vertices.h"
#include "topology/complex/ridge_walk.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <iterator>

namespace slabhull {

namespace {

/// The vertices that `cells` use, ascending; the cells are renumbered to their places in this list.
template<int D>
std::vector<VertexId> renumber(Array<Simplex<D>>& cells, std::size_t vertex_count) {
    const UsedVertices used{vertex_count, cells};
    used.renumber(cells);
    std::vector<VertexId> ids;
    ids.reserve(used.vertices.size());
    for (const Index v : used.vertices) {
        ids.emplace_back(v);
    }
    return ids;
}

/// Adjacency of the boundary's facets, which are given ascending: neighbour k is across the ridge opposite to
/// vertex k of the facet as outward_facet() orders it.
template<int D>
Array<Neighbors<D - 1>> boundary_adjacency(const SimplicialComplex<D>& whole,
                                           const std::vector<HalfFacetId<D>>& facets) {
    const RidgeWalk<D> walk{whole.cell_array(), whole.neighbor_array()};
    Array<Neighbors<D - 1>> neighbors(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const CellId cell = facets[f].cell();
        const auto vertices = whole.vertices(cell);
        const auto corners = whole.vertices(facets[f]);
        for (std::size_t k = 0; k < D; ++k) {
            const auto out = static_cast<std::size_t>(
                std::find(vertices.begin(), vertices.end(), corners[k]) - vertices.begin());
            const auto end = walk.last({cell.slot(), facets[f].place(), out});
            if (!end) {
                throw GeometryError{"the neighbours of the complex do not fit its cells",
                                    {{"cell", cell.slot(), ""}}};
            }
            const HalfFacetId<D> other{CellId{end->cell}, end->out};
            neighbors[f][k] =
                static_cast<Index>(std::lower_bound(facets.begin(), facets.end(), other) - facets.begin());
        }
    }
    return neighbors;
}

} // namespace

template<int D>
PartOfComplex<D, CellId> part_of(const SimplicialComplex<D>& whole, std::span<const CellId> chosen) {
    Array<Simplex<D>> cells;
    cells.reserve(chosen.size());
    for (const CellId cell : chosen) {
        cells.push_back(whole.cell_array()[cell.slot()]);
    }
    std::vector<VertexId> used = renumber<D>(cells, whole.vertex_count());
    return {SimplicialComplex<D>::from_soup(std::move(cells), used.size()),
            std::move(used),
            {chosen.begin(), chosen.end()}};
}

template<int D>
PartOfComplex<D - 1, HalfFacetId<D>> boundary_of(const SimplicialComplex<D>& whole) {
    std::vector<HalfFacetId<D>> facets;
    Array<Simplex<D - 1>> cells;
    for (const HalfFacetId<D> h : whole.boundary_facets()) {
        facets.push_back(h);
        const auto corners = whole.vertices(h);
        std::transform(corners.begin(), corners.end(), cells.emplace_back().begin(),
                       [](VertexId v) { return v.slot(); });
    }
    std::vector<VertexId> used = renumber<D - 1>(cells, whole.vertex_count());
    Array<Neighbors<D - 1>> neighbors = boundary_adjacency<D>(whole, facets);
    return {SimplicialComplex<D - 1>::adopt(std::move(cells), std::move(neighbors), used.size()),
            std::move(used), std::move(facets)};
}

std::vector<std::vector<VertexId>> loops(const SimplicialComplex<1>& curve) {
    const RidgeWalk<1> walk{curve.cell_array(), curve.neighbor_array()};
    std::vector<char> met(curve.cell_count(), 0);
    std::vector<std::vector<VertexId>> result;
    for (const CellId start : curve.cells()) {
        if (met[start.slot()] != 0) {
            continue;
        }
        std::vector<VertexId>& chain = result.emplace_back();
        Turn last{};
        for (const Turn& turn : walk.fan({start.slot(), 1, 0})) {
            met[turn.cell] = 1;
            chain.push_back(curve.apex({CellId{turn.cell}, turn.out}));
            last = turn;
        }
        const VertexId end = curve.apex({CellId{last.cell}, last.in});
        if (end != chain.front()) {
            chain.push_back(end);
        }
    }
    return result;
}

std::vector<std::vector<VertexId>> boundary_loops(const SimplicialComplex<2>& surface) {
    const auto boundary = boundary_of<2>(surface);
    std::vector<std::vector<VertexId>> result = loops(boundary.complex);
    for (std::vector<VertexId>& loop : result) {
        for (VertexId& v : loop) {
            v = boundary.vertices[v.slot()];
        }
    }
    return result;
}

template PartOfComplex<1, CellId> part_of<1>(const SimplicialComplex<1>&, std::span<const CellId>);
template PartOfComplex<2, CellId> part_of<2>(const SimplicialComplex<2>&, std::span<const CellId>);
template PartOfComplex<3, CellId> part_of<3>(const SimplicialComplex<3>&, std::span<const CellId>);
template PartOfComplex<1, HalfFacetId<2>> boundary_of<2>(const SimplicialComplex<2>&);
template PartOfComplex<2, HalfFacetId<3>> boundary_of<3>(const SimplicialComplex<3>&);

} // namespace slabhull
