// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/cap_cells.h"

#include "core/pieces.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Rows that each rank has a range of, in other ranges. Collective.
template<class Row>
Array<Row> redistributed_rows(const Array<Row>& rows, const HullRange& here, const HullRange& wanted,
                              Communicator& ranks) {
    std::vector<Array<Row>> to;
    for (const HullRange& there : ranks.gather(wanted)) {
        const std::size_t begin = std::max(here.first, there.first);
        const std::size_t end = std::max(begin, std::min(here.end(), there.end()));
        to.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(std::min(begin - here.first, rows.size())),
                        rows.begin() + static_cast<std::ptrdiff_t>(std::min(end - here.first, rows.size())));
    }
    return joined(ranks.all_to_all(to));
}

} // namespace

template<int D>
void leave_cells_on_first(SpatialMesh<D>& cap, const Communicator& ranks) {
    if (!ranks.first()) {
        Array<Simplex<D>>{}.swap(cap.cells); // assigning {} would keep the memory
        Array<Neighbors<D>>{}.swap(cap.neighbors);
    }
}

template<int D>
CapCells<D> take_cells(SpatialMesh<D>& cap, Communicator& ranks) {
    CapCells<D> taken;
    taken.range = {ranks.sum_before(cap.cells.size()), cap.cells.size()};
    taken.all = ranks.sum(cap.cells.size());
    taken.cells.swap(cap.cells);
    taken.neighbors.swap(cap.neighbors);
    return taken;
}

template<int D>
CapCells<D> redistributed(CapCells<D>&& cells, const HullRange& wanted, Communicator& ranks) {
    CapCells<D> result{cells.all, wanted, {}, {}};
    result.cells = redistributed_rows(cells.cells, cells.range, wanted, ranks);
    Array<Simplex<D>>{}.swap(cells.cells);
    result.neighbors = redistributed_rows(cells.neighbors, cells.range, wanted, ranks);
    Array<Neighbors<D>>{}.swap(cells.neighbors);
    return result;
}

template<int D>
CapCells<D> terminating_cells_of(const HullPart<D>& part, const HullOrder<D>& order) {
    const std::size_t first_cell = order.terminating_begin();
    const std::size_t first_point = order.terminating_points_begin();
    const std::size_t end = part.range.end();
    const std::size_t begin = std::clamp(first_cell, part.range.first, end);
    CapCells<D> cap;
    cap.all = part.hull_cells - first_cell;
    cap.range = {begin < first_cell ? 0 : begin - first_cell, end - begin};
    cap.cells.resize(end - begin);
    cap.neighbors.resize(end - begin);
    for (std::size_t c = begin; c < end; ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const std::size_t row = c - part.range.first;
            const std::uint64_t across = part.in_hull(part.neighbors[row][i]);
            cap.cells[c - begin][i] =
                static_cast<Index>(part.points_used->member(part.cells[row][i]) - first_point);
            cap.neighbors[c - begin][i] =
                across < first_cell ? no_index : static_cast<Index>(across - first_cell);
        }
    }
    return cap;
}

template<int D>
Array<Simplex<D>> all_cells_on_first(const CapCells<D>& cells, Communicator& ranks) {
    const HullRange wanted{0, ranks.first() ? cells.all : 0};
    return redistributed_rows(cells.cells, cells.range, wanted, ranks);
}

template Array<Simplex<2>> all_cells_on_first<2>(const CapCells<2>&, Communicator&);
template Array<Simplex<3>> all_cells_on_first<3>(const CapCells<3>&, Communicator&);
template void leave_cells_on_first<2>(SpatialMesh<2>&, const Communicator&);
template void leave_cells_on_first<3>(SpatialMesh<3>&, const Communicator&);
template CapCells<2> take_cells<2>(SpatialMesh<2>&, Communicator&);
template CapCells<3> take_cells<3>(SpatialMesh<3>&, Communicator&);
template CapCells<2> redistributed<2>(CapCells<2>&&, const HullRange&, Communicator&);
template CapCells<3> redistributed<3>(CapCells<3>&&, const HullRange&, Communicator&);
template CapCells<2> terminating_cells_of<2>(const HullPart<2>&, const HullOrder<2>&);
template CapCells<3> terminating_cells_of<3>(const HullPart<3>&, const HullOrder<3>&);

} // namespace slabhull
