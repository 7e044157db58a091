// SPDX-License-Identifier: BSD-3-Clause
#include "hull_view.h"

#include <fmt/format.h>

#include <utility>

namespace slabhull {

namespace {

void check_length(Column<std::int64_t>& column, const char* name, std::size_t rows, int components,
                  Findings& findings) {
    if (!column.given() || (column.rows() == rows && column.components() == components)) {
        return;
    }
    findings.other(Defect::column_length, {},
                   fmt::format("the array {} has {} rows of {}, expected {} of {}", name, column.rows(),
                               column.components(), rows, components));
    column = {};
}

/// A cell's times and the layer it is said to be in.
struct LayerCell {
    std::int64_t layer;
    std::array<double, 2> span;
    Index cell;
};

template<int D>
std::vector<LayerCell> side_by_layer(const HullView<D>& view, Findings& findings) {
    std::vector<LayerCell> side;
    each_row(view.hull.layer, [&](std::size_t c, const std::int64_t* claimed) {
        if (view.in_cap(c) ? *claimed != -1 : *claimed < 0) {
            findings.cell(Defect::wrong_layer, static_cast<Index>(c),
                          fmt::format("layer {} {}", *claimed, view.in_cap(c) ? "in a cap" : "on the side"));
        } else if (!view.in_cap(c)) {
            side.push_back({*claimed, view.span_of(c), static_cast<Index>(c)});
        }
    });
    std::stable_sort(side.begin(), side.end(),
                     [](const LayerCell& a, const LayerCell& b) { return a.layer < b.layer; });
    return side;
}

/// The most frequent first (end = 0) or last (end = 1) time: cells that do not belong do not move it.
double commonest_time(std::span<const LayerCell> layer, std::size_t end) {
    std::vector<double> times;
    for (const LayerCell& cell : layer) {
        times.push_back(cell.span[end]);
    }
    std::sort(times.begin(), times.end());
    double commonest = times.front();
    std::size_t most = 0;
    for (auto run = times.begin(); run != times.end();) {
        const auto next = std::upper_bound(run, times.end(), *run);
        if (static_cast<std::size_t>(next - run) > most) {
            most = static_cast<std::size_t>(next - run);
            commonest = *run;
        }
        run = next;
    }
    return commonest;
}

/// Returns the layer's times.
std::array<double, 2> check_layer(std::span<const LayerCell> layer, Findings& findings) {
    const std::array<double, 2> times{commonest_time(layer, 0), commonest_time(layer, 1)};
    for (const LayerCell& cell : layer) {
        if (cell.span[0] < times[0] || cell.span[1] > times[1]) {
            findings.cell(Defect::wrong_layer, cell.cell,
                          fmt::format("its times [{}, {}] are not within [{}, {}] of layer {}", cell.span[0],
                                      cell.span[1], times[0], times[1], cell.layer));
        }
    }
    return times;
}

void report_gap(std::int64_t layer, const std::string& detail, Findings& findings) {
    findings.other(Defect::layer_gap, {{"layer", layer, {}}}, fmt::format("layer {}: {}", layer, detail));
}

} // namespace

template<int D>
void check_column_lengths(HullColumns<D>& hull, Findings& findings) {
    check_length(hull.region, "region", hull.cells.size(), 1, findings);
    check_length(hull.patch, "patch", hull.cells.size(), 1, findings);
    check_length(hull.layer, "layer", hull.cells.size(), 1, findings);
    check_length(hull.neighbors, "neighbors", hull.cells.size(), D + 1, findings);
    check_length(hull.vertex_id, "vertex_id", hull.points.size(), 1, findings);
    check_length(hull.track_id, "track_id", hull.points.size(), 1, findings);
    check_length(hull.cell_of_vertex, "cell", hull.points.size(), 1, findings);
}

template<int D>
std::size_t check_layers(const HullView<D>& view, Findings& findings) {
    const std::vector<LayerCell> side = side_by_layer(view, findings);
    std::int64_t layers = 0;
    double reached = view.time[0];
    for (auto run = side.begin(); run != side.end();) {
        const auto end =
            std::find_if(run, side.end(), [&](const LayerCell& c) { return c.layer != run->layer; });
        const std::array<double, 2> times = check_layer({run, end}, findings);
        if (run->layer != layers) {
            report_gap(layers, "no cell is in it", findings);
        } else if (times[0] != reached) {
            report_gap(layers, fmt::format("starts at t = {}, not at {}", times[0], reached), findings);
        }
        layers = run->layer + 1;
        reached = times[1];
        run = end;
    }
    if (!side.empty() && reached != view.time[1]) {
        report_gap(layers - 1, fmt::format("ends at t = {}, not at the slab's end {}", reached, view.time[1]),
                   findings);
    }
    return static_cast<std::size_t>(layers);
}

template<int D>
void check_vertex_ids(const HullView<D>& view, Findings& findings) {
    const auto ids = read_column<PersistentId>(view.hull.vertex_id);
    std::vector<Index> order(ids.size());
    for (std::size_t v = 0; v < ids.size(); ++v) {
        order[v] = static_cast<Index>(v);
        if (ids[v] < 0) {
            findings.vertex(Defect::negative_vertex_id, order[v], fmt::format("its id is {}", ids[v]));
        }
    }
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        return std::pair{ids[a], a} < std::pair{ids[b], b};
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (ids[order[k]] == ids[order[k - 1]] && ids[order[k]] >= 0) {
            const std::array<Index, 2> both{order[k - 1], order[k]};
            const std::vector<Entity> names = findings.vertex_entities(both);
            findings.other(Defect::duplicate_vertex_id, names,
                           fmt::format("vertices {} and {}: both have the id {}", names[0].number,
                                       names[1].number, ids[order[k]]));
        }
    }
}

template<int D>
void check_neighbors(const HullView<D>& view, Findings& findings) {
    each_row(view.hull.neighbors, [&](std::size_t c, const std::int64_t* claimed) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index actual = view.adjacency.neighbors[c][i];
            if (actual == no_index || claimed[i] == std::int64_t{actual}) {
                continue; // a facet without a neighbour is reported as open or overfull
            }
            const std::array<Index, 2> both{static_cast<Index>(c), actual};
            findings.cells(
                Defect::wrong_neighbor, both,
                fmt::format("across facet {} the array says {}, the facet says another", i, claimed[i]));
        }
    });
}

template<int D>
void check_cell_of_vertex(const HullView<D>& view, Findings& findings) {
    each_row(view.hull.cell_of_vertex, [&](std::size_t v, const std::int64_t* claimed) {
        const bool exists = *claimed >= 0 && static_cast<std::size_t>(*claimed) < view.cells().size();
        const auto uses = [&](const Simplex<D>& cell) {
            return std::find(cell.begin(), cell.end(), static_cast<Index>(v)) != cell.end();
        };
        if (!exists || !uses(view.cells()[static_cast<std::size_t>(*claimed)])) {
            findings.vertex(Defect::wrong_vertex_cell, static_cast<Index>(v),
                            fmt::format("{} is not a cell that uses it", *claimed));
        }
    });
}

template void check_column_lengths<2>(HullColumns<2>&, Findings&);
template void check_column_lengths<3>(HullColumns<3>&, Findings&);
template std::size_t check_layers<2>(const HullView<2>&, Findings&);
template std::size_t check_layers<3>(const HullView<3>&, Findings&);
template void check_vertex_ids<2>(const HullView<2>&, Findings&);
template void check_vertex_ids<3>(const HullView<3>&, Findings&);
template void check_neighbors<2>(const HullView<2>&, Findings&);
template void check_neighbors<3>(const HullView<3>&, Findings&);
template void check_cell_of_vertex<2>(const HullView<2>&, Findings&);
template void check_cell_of_vertex<3>(const HullView<3>&, Findings&);

} // namespace slabhull
