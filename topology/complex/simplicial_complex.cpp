// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/simplicial_complex.h"

#include "topology/complex/ridge_walk.h"
#include "topology/complex/soup_manifold.h"
#include "topology/complex/star.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace slabhull {

namespace {

template<int D>
[[noreturn]] void refuse_view(std::size_t cell, const char* what) {
    throw GeometryError{fmt::format("the complex cannot be opened: cell {} {}", cell, what),
                        {{"cell", static_cast<std::int64_t>(cell), ""}}};
}

template<int D>
void require_in_range(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors,
                      std::size_t vertex_count) {
    if (cells.size() != neighbors.size()) {
        throw GeometryError{fmt::format("the complex cannot be opened: {} cells, but neighbours of {}",
                                        cells.size(), neighbors.size())};
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (std::any_of(cells[c].begin(), cells[c].end(), [=](Index v) { return v >= vertex_count; })) {
            refuse_view<D>(c, "refers to a vertex that does not exist");
        }
        if (std::any_of(neighbors[c].begin(), neighbors[c].end(),
                        [&](Index n) { return n != no_index && n >= cells.size(); })) {
            refuse_view<D>(c, "has a neighbour that does not exist");
        }
    }
}

template<int D>
std::size_t place_in(const Simplex<D>& cell, Index vertex) {
    return static_cast<std::size_t>(std::find(cell.begin(), cell.end(), vertex) - cell.begin());
}

/// Whether (ridge, q at `out`, p at `in`), the ridge in the order of its vertices' places, is the orientation
/// of a cell. Both are moved to the end past the places that follow them: `in` first, then `out`.
template<int D>
bool is_positive(std::size_t out, std::size_t in) {
    const std::size_t jumps = (D - in) + (D - out) - (in > out ? 1 : 0);
    return jumps % 2 == 0;
}

/// The turn about the ridge opposite to places i and j with the cell's orientation.
template<int D>
Turn positive_turn(Index cell, std::size_t i, std::size_t j) {
    return is_positive<D>(i, j) ? Turn{cell, j, i} : Turn{cell, i, j};
}

std::vector<CellId> cells_of(const std::vector<Turn>& turns) {
    std::vector<CellId> result;
    result.reserve(turns.size());
    for (const Turn& turn : turns) {
        result.emplace_back(turn.cell);
    }
    return result;
}

/// The turns about an edge, such that each cell has a, b, vertex `out`, vertex `in` in its orientation; none
/// when there is no such edge.
std::vector<Turn> turns_about(const SimplicialComplex<3>& complex, VertexId a, VertexId b) {
    const std::vector<CellId> star = complex.star(a);
    const auto at_edge =
        std::find_if(star.begin(), star.end(), [&](CellId cell) { return complex.has(cell, b); });
    if (a == b || at_edge == star.end()) {
        return {};
    }
    const Simplex<3>& cell = complex.cell_array()[at_edge->slot()];
    const std::size_t at_a = place_in<3>(cell, a.slot());
    const std::size_t at_b = place_in<3>(cell, b.slot());
    std::array<std::size_t, 2> off{};
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
        if (i != at_a && i != at_b) {
            off[k++] = i;
        }
    }
    const Turn turn = positive_turn<3>(at_edge->slot(), off[0], off[1]);
    const RidgeWalk<3> walk{complex.cell_array(), complex.neighbor_array()};
    return walk.fan(at_a < at_b ? turn : turn.reversed());
}

} // namespace

template<int D>
SimplicialComplex<D>::SimplicialComplex(std::span<const Simplex<D>> cells,
                                        std::span<const Neighbors<D>> neighbors, std::size_t vertex_count)
    : cells_{cells}, neighbors_{neighbors} {
    cell_of_.assign(vertex_count, no_index);
    for (std::size_t c = cells.size(); c-- > 0;) {
        for (const Index v : cells[c]) {
            cell_of_[v] = static_cast<Index>(c);
        }
    }
}

template<int D>
SimplicialComplex<D> SimplicialComplex<D>::from_soup(Array<Simplex<D>> cells, std::size_t vertex_count) {
    checked_index(vertex_count, "vertices");
    Adjacency<D> adjacency = manifold_adjacency<D>(cells, vertex_count);
    return adopt(std::move(cells), std::move(adjacency.neighbors), vertex_count);
}

template<int D>
SimplicialComplex<D> SimplicialComplex<D>::view(std::span<const Simplex<D>> cells,
                                                std::span<const Neighbors<D>> neighbors,
                                                std::size_t vertex_count) {
    checked_index(vertex_count, "vertices");
    checked_index(cells.size(), "cells");
    require_in_range<D>(cells, neighbors, vertex_count);
    return SimplicialComplex{cells, neighbors, vertex_count};
}

template<int D>
SimplicialComplex<D> SimplicialComplex<D>::adopt(Array<Simplex<D>> cells, Array<Neighbors<D>> neighbors,
                                                 std::size_t vertex_count) {
    SimplicialComplex complex = view(cells, neighbors, vertex_count);
    complex.own_cells_ = std::move(cells); // moving keeps the memory that the spans refer to
    complex.own_neighbors_ = std::move(neighbors);
    return complex;
}

// --- in and around a cell

template<int D>
auto SimplicialComplex<D>::vertices(CellId cell) const -> std::array<VertexId, corners> {
    std::array<VertexId, corners> result;
    std::transform(cells_[cell.slot()].begin(), cells_[cell.slot()].end(), result.begin(),
                   [](Index v) { return VertexId{v}; });
    return result;
}

template<int D>
auto SimplicialComplex<D>::edges(CellId cell) const -> std::array<std::array<VertexId, 2>, edges_per_cell> {
    const auto v = vertices(cell);
    std::array<std::array<VertexId, 2>, edges_per_cell> result;
    for (std::size_t i = 0, k = 0; i < corners; ++i) {
        for (std::size_t j = i + 1; j < corners; ++j) {
            result[k++] = {v[i], v[j]};
        }
    }
    return result;
}

template<int D>
auto SimplicialComplex<D>::half_facets(CellId cell) const -> std::array<HalfFacet, corners> {
    std::array<HalfFacet, corners> result;
    for (std::size_t i = 0; i < corners; ++i) {
        result[i] = {cell, i};
    }
    return result;
}

template<int D>
bool SimplicialComplex<D>::has(CellId cell, VertexId vertex) const {
    return place_in<D>(cells_[cell.slot()], vertex.slot()) < corners;
}

// --- across a facet

template<int D>
HalfFacetId<D> SimplicialComplex<D>::mirror(HalfFacet h) const {
    const auto place = RidgeWalk<D>{cells_, neighbors_}.place_seen_from_across(h.cell().slot(), h.place());
    return place ? HalfFacet{across(h), *place} : HalfFacet{};
}

template<int D>
std::array<VertexId, D> SimplicialComplex<D>::vertices(HalfFacet h) const {
    if constexpr (D == 1) {
        return {VertexId{cells_[h.cell().slot()][1 - h.place()]}};
    } else {
        const Facet<D> facet = outward_facet<D>(cells_[h.cell().slot()], static_cast<int>(h.place()));
        std::array<VertexId, D> result;
        std::transform(facet.begin(), facet.end(), result.begin(), [](Index v) { return VertexId{v}; });
        return result;
    }
}

// --- around a vertex

template<int D>
std::vector<CellId> SimplicialComplex<D>::star(VertexId vertex) const {
    const CellId first = cell_of(vertex);
    if (!first.valid()) {
        return {};
    }
    if constexpr (D == 2) {
        const std::size_t at = place_in<2>(cells_[first.slot()], vertex.slot());
        const Turn start = positive_turn<2>(first.slot(), (at + 1) % 3, (at + 2) % 3);
        return cells_of(RidgeWalk<2>{cells_, neighbors_}.fan(start));
    } else {
        std::vector<CellId> result;
        StarWalker<D> walker{cells_, neighbors_};
        for (const Index c : walker.walk(vertex.slot(), first.slot())) {
            if (has(CellId{c}, vertex)) { // always, unless the neighbours make no sense
                result.emplace_back(c);
            }
        }
        return result;
    }
}

template<int D>
std::vector<HalfFacetId<D>> SimplicialComplex<D>::link(VertexId vertex) const {
    std::vector<HalfFacet> result;
    for (const CellId cell : star(vertex)) {
        result.emplace_back(cell, place_in<D>(cells_[cell.slot()], vertex.slot()));
    }
    return result;
}

template<int D>
std::vector<VertexId> SimplicialComplex<D>::neighbors(VertexId vertex) const {
    LocalNumbering met;
    for (const CellId cell : star(vertex)) {
        for (const Index v : cells_[cell.slot()]) {
            if (v != vertex.slot()) {
                met.number(v);
            }
        }
    }
    std::vector<VertexId> result;
    std::transform(met.keys().begin(), met.keys().end(), std::back_inserter(result),
                   [](Index v) { return VertexId{v}; });
    return result;
}

// --- around an edge

template<int D>
std::vector<CellId> SimplicialComplex<D>::star(VertexId a, VertexId b) const {
    if constexpr (D == 3) {
        return cells_of(turns_about(*this, a, b));
    } else {
        std::vector<CellId> result;
        if (a != b) {
            result = star(a);
            std::erase_if(result, [&](CellId cell) { return !has(cell, b); });
        }
        return result;
    }
}

template<int D>
std::vector<VertexId> SimplicialComplex<D>::link(VertexId a, VertexId b) const {
    std::vector<VertexId> result;
    if constexpr (D == 3) {
        const std::vector<Turn> turns = turns_about(*this, a, b);
        for (const Turn& turn : turns) {
            result.push_back(apex({CellId{turn.cell}, turn.out}));
        }
        if (!turns.empty() && apex({CellId{turns.back().cell}, turns.back().in}) != result.front()) {
            result.push_back(apex({CellId{turns.back().cell}, turns.back().in}));
        }
    } else {
        for (const CellId cell : star(a, b)) {
            std::ranges::copy_if(vertices(cell), std::back_inserter(result),
                                 [=](VertexId v) { return v != a && v != b; });
        }
    }
    return result;
}

template class SimplicialComplex<1>;
template class SimplicialComplex<2>;
template class SimplicialComplex<3>;

} // namespace slabhull
