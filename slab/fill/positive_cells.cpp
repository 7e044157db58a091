// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/positive_cells.h"

#include "slab/check/findings.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/simplex_sign.h"

#include <fmt/format.h>

#include <string>

namespace slabhull {

template<int D>
void require_positive(const Filling<D>& filling, const SlabColumns<D>& columns, const ConeCells<D>& cones) {
    constexpr std::size_t most_named = 10;
    const std::vector<Index> bad = select(filling.cells.size(), [&](std::size_t c) {
        return simplex_sign<D + 1>(corners_of<D + 1, D + 1>(filling.cells[c], filling.points)) <= 0;
    });
    if (bad.empty()) {
        return;
    }
    std::vector<Entity> entities;
    std::string places;
    Index last_cell = no_index;
    std::size_t last_layer = 0;
    for (const Index simplex : bad) {
        const std::size_t layer = simplex / cones.cells_per_layer();
        const Index cell = cones.cell_of(simplex % cones.cells_per_layer());
        if ((cell == last_cell && layer == last_layer) || entities.size() == 2 * most_named) {
            continue;
        }
        entities.push_back({"cell", cell, {}});
        entities.push_back({"layer", static_cast<std::int64_t>(layer), {}});
        places += fmt::format("{} cell {} in layer {} (t = {} to {})", places.empty() ? "" : ",", cell, layer,
                              columns.times[layer], columns.times[layer + 1]);
        last_cell = cell;
        last_layer = layer;
    }
    throw GeometryError{
        fmt::format("{} of {} simplices of the filling would be inside out or flat, over the "
                    "initial cap's{}; more layers (time.layers) or shorter slabs (time.slabs) "
                    "help, since each then turns less",
                    bad.size(), filling.cells.size(), places),
        std::move(entities)};
}

template void require_positive<2>(const Filling<2>&, const SlabColumns<2>&, const ConeCells<2>&);
template void require_positive<3>(const Filling<3>&, const SlabColumns<3>&, const ConeCells<3>&);

} // namespace slabhull
