// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/hull_view.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
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

/// Whether a side cell's claim is a layer at all; other claims are reported separately.
bool is_side_layer(std::int64_t claimed) {
    return claimed >= 0;
}

template<int D>
Layers collect_layers(const HullView<D>& view) {
    constexpr std::size_t grain = 1 << 16;
    Layers layers;
    std::mutex lock;
    parallel_for(view.cells().size(), grain, [&](std::size_t begin, std::size_t end) {
        Array<std::int64_t> claimed(end - begin); // not cleared first
        view.hull.layer.fill(begin, end, claimed.data());
        Layers found;
        std::int64_t last = -1; // the next cell is mostly in the same layer
        LayerTimes* times = nullptr;
        for (std::size_t c = begin; c < end; ++c) {
            if (!view.in_cap(c) && is_side_layer(claimed[c - begin])) {
                if (claimed[c - begin] != last) {
                    last = claimed[c - begin];
                    times = &found[last];
                }
                const std::array<double, 2> span = view.span_of(c);
                ++(*times)[0][span[0] + 0.0]; // 0.0 and -0.0 are one time
                ++(*times)[1][span[1] + 0.0];
            }
        }
        const std::lock_guard guard{lock};
        for (const auto& [layer, more] : found) {
            add_layer_times(layers[layer], more);
        }
    });
    return layers;
}

/// The most frequent time: a few misplaced cells do not change it.
double commonest(const TimeCounts& times) {
    return std::max_element(times.begin(), times.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

template<int D>
void report_layers_of_wrong_regions(const HullView<D>& view, Findings& findings) {
    const auto bad = select_rows(view.hull.layer, [&](std::size_t c, const std::int64_t* claimed) {
        return view.in_cap(c) ? *claimed != -1 : !is_side_layer(*claimed);
    });
    for (const Index c : bad) {
        findings.cell(Defect::wrong_layer, c,
                      fmt::format("layer {} {}", row_of(view.hull.layer, c)[0],
                                  view.in_cap(c) ? "in a cap" : "on the side"));
    }
}

using LayerSpans = std::map<std::int64_t, std::array<double, 2>>;

/// Side cells whose times are not within those of their layer, by layer.
template<int D>
std::multimap<std::int64_t, Index> cells_out_of_layer(const HullView<D>& view, const LayerSpans& spans) {
    const auto bad = select_rows(view.hull.layer, [&](std::size_t c, const std::int64_t* claimed) {
        if (view.in_cap(c) || !is_side_layer(*claimed)) {
            return false;
        }
        const std::array<double, 2>& layer = spans.at(*claimed);
        const std::array<double, 2> span = view.span_of(c);
        return span[0] < layer[0] || span[1] > layer[1];
    });
    std::multimap<std::int64_t, Index> by_layer;
    for (const Index c : bad) {
        by_layer.emplace(row_of(view.hull.layer, c)[0], c);
    }
    return by_layer;
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

void add_layer_times(LayerTimes& sum, const LayerTimes& more) {
    for (std::size_t end = 0; end < 2; ++end) {
        for (const auto& [time, count] : more[end]) {
            sum[end][time] += count;
        }
    }
}

template<int D>
std::size_t check_layers(const HullView<D>& view, Findings& findings,
                         const std::function<void(Layers& layers)>& complete) {
    report_layers_of_wrong_regions(view, findings);
    Layers all = collect_layers(view);
    if (complete) {
        complete(all);
    }
    LayerSpans spans;
    for (const auto& [layer, times] : all) {
        spans[layer] = {commonest(times[0]), commonest(times[1])};
    }
    const auto out_of_layer = cells_out_of_layer(view, spans);
    std::int64_t layers = 0;
    double reached = view.time[0];
    for (const auto& [layer, times] : spans) {
        const auto [begin, end] = out_of_layer.equal_range(layer);
        for (auto cell = begin; cell != end; ++cell) {
            const std::array<double, 2> span = view.span_of(cell->second);
            findings.cell(Defect::wrong_layer, cell->second,
                          fmt::format("its times [{}, {}] are not within [{}, {}] of layer {}", span[0],
                                      span[1], times[0], times[1], layer));
        }
        if (layer != layers) {
            report_gap(layers, "no cell is in it", findings);
        } else if (times[0] != reached) {
            report_gap(layers, fmt::format("starts at t = {}, not at {}", times[0], reached), findings);
        }
        layers = layer + 1;
        reached = times[1];
    }
    if (!spans.empty() && reached != view.time[1]) {
        report_gap(layers - 1, fmt::format("ends at t = {}, not at the slab's end {}", reached, view.time[1]),
                   findings);
    }
    return static_cast<std::size_t>(layers);
}

template<int D>
void check_vertex_ids(const HullView<D>& view, Findings& findings) {
    const IntegerList ids = read_ids(view.hull.vertex_id);
    if (ids.empty() || (ids[0] >= 0 && ids.ascending())) {
        return; // ids of a march ascend: no need to sort
    }
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
    // A facet without a neighbour is reported as open or overfull.
    const auto differs = [&](std::size_t c, std::size_t i, std::int64_t claimed) {
        const Index actual = view.adjacency.neighbors[c][i];
        return actual != no_index && claimed != std::int64_t{actual};
    };
    const auto bad = select_rows(view.hull.neighbors, [&](std::size_t c, const std::int64_t* claimed) {
        bool any = false;
        for (std::size_t i = 0; i <= D; ++i) {
            any = any || differs(c, i, claimed[i]);
        }
        return any;
    });
    for (const Index c : bad) {
        const std::vector<std::int64_t> claimed = row_of(view.hull.neighbors, c);
        for (std::size_t i = 0; i <= D; ++i) {
            if (differs(c, i, claimed[i])) {
                const std::array<Index, 2> both{c, view.adjacency.neighbors[c][i]};
                findings.cells(
                    Defect::wrong_neighbor, both,
                    fmt::format("across facet {} the array says {}, the facet says another", i, claimed[i]));
            }
        }
    }
}

template<int D>
void check_cell_of_vertex(const HullView<D>& view, Findings& findings) {
    const auto bad = select_rows(view.hull.cell_of_vertex, [&](std::size_t v, const std::int64_t* claimed) {
        const bool exists = *claimed >= 0 && static_cast<std::size_t>(*claimed) < view.cells().size();
        const auto uses = [&](const Simplex<D>& cell) {
            return std::find(cell.begin(), cell.end(), static_cast<Index>(v)) != cell.end();
        };
        return !exists || !uses(view.cells()[static_cast<std::size_t>(*claimed)]);
    });
    for (const Index v : bad) {
        findings.vertex(Defect::wrong_vertex_cell, v,
                        fmt::format("{} is not a cell that uses it", row_of(view.hull.cell_of_vertex, v)[0]));
    }
}

template void check_column_lengths<2>(HullColumns<2>&, Findings&);
template void check_column_lengths<3>(HullColumns<3>&, Findings&);
template std::size_t check_layers<2>(const HullView<2>&, Findings&, const std::function<void(Layers&)>&);
template std::size_t check_layers<3>(const HullView<3>&, Findings&, const std::function<void(Layers&)>&);
template void check_vertex_ids<2>(const HullView<2>&, Findings&);
template void check_vertex_ids<3>(const HullView<3>&, Findings&);
template void check_neighbors<2>(const HullView<2>&, Findings&);
template void check_neighbors<3>(const HullView<3>&, Findings&);
template void check_cell_of_vertex<2>(const HullView<2>&, Findings&);
template void check_cell_of_vertex<3>(const HullView<3>&, Findings&);

} // namespace slabhull
