// SPDX-License-Identifier: BSD-3-Clause
// How to part a hull among ranks: by equal ranges of its own order, as `slabhull` does, by equal ranges along
// a curve through space, and by METIS and Scotch. Hulls of the turning ellipsoid that are mostly caps, and
// mostly side. A line of JSON each: facets cut, points that several parts use, ghosts (cells of other parts
// at those points), the largest part beside the mean, and seconds. A partition counts when each cell has a
// part, and no part is empty.
//     bench_slab_partition [MILLIONS_OF_TETRAHEDRA [PARTS ...]]
#include "partition.h"

#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/geometry/mesh_order.h"
#include "slabhull/slab/slab.h"
#include "slabhull/topology/dual_graph.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <set>

using namespace slabhull;
using bench::CellGraph;
using bench::Partitioner;

namespace {

/// The experiment's hull with about so many tetrahedra; refinement 1.187 gives 367,000.
Hull<3> hull_of(double tets, Bulk bulk) {
    const Case the_case = experiment_at("ellipsoid", 1.187 * std::cbrt(tets / 367'000), bulk);
    IdCounter ids;
    StageClock clock;
    const SpatialMesh<3> cap = initial_cap<3>(the_case, ids, {}, clock);
    const auto settings = settings_of<3>(the_case, boundary_of(cap));
    return build_slab<3>(cap, boundary_of(cap), 0, the_case.level_times(0), settings, ids, clock).hull;
}

CellGraph graph_of(const Hull<3>& hull) {
    const DualGraph<3> dual{hull.neighbors};
    CellGraph graph;
    graph.first.push_back(0);
    for (Index cell = 0; cell < num_vertices(dual); ++cell) {
        const auto [begin, end] = adjacent_vertices(cell, dual);
        for (auto next = begin; next != end; ++next) {
            graph.targets.push_back(static_cast<std::int32_t>(*next));
        }
        graph.first.push_back(static_cast<std::int32_t>(graph.targets.size()));
    }
    return graph;
}

/// Cell i of `order` is in part i * parts / cells.
std::vector<std::int32_t> by_ranges(const Array<Index>& order, int parts) {
    std::vector<std::int32_t> part_of(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        part_of[order[i]] = static_cast<std::int32_t>(i * static_cast<std::size_t>(parts) / order.size());
    }
    return part_of;
}

Array<Index> own_order(const Hull<3>& hull) {
    Array<Index> order(hull.cells.size());
    std::iota(order.begin(), order.end(), 0U);
    return order;
}

/// Along a Z curve through the cells' centres in space, whenever they are.
Array<Index> spatial_order(const Hull<3>& hull) {
    Array<Point<3>> centres(hull.cells.size());
    for (std::size_t cell = 0; cell < centres.size(); ++cell) {
        for (std::size_t k = 0; k < 3; ++k) {
            centres[cell][k] = 0;
            for (const Index v : hull.cells[cell]) {
                centres[cell][k] += hull.points[v][k] / 4;
            }
        }
    }
    return curve_order<3>(centres);
}

struct Quality {
    std::size_t cut_facets = 0;
    std::size_t shared_points = 0;
    std::size_t ghosts = 0;  ///< over all parts
    double largest_part = 0; ///< beside the mean
};

void require(bool sound, const std::string& what) {
    if (!sound) {
        std::fprintf(stderr, "%s\n", what.c_str());
        std::exit(1);
    }
}

std::size_t count_cut_facets(const CellGraph& graph, const std::vector<std::int32_t>& part_of) {
    std::size_t directed = 0;
    for (std::size_t cell = 0; cell + 1 < graph.first.size(); ++cell) {
        for (auto k = graph.first[cell]; k < graph.first[cell + 1]; ++k) {
            directed += part_of[cell] !=
                        part_of[static_cast<std::size_t>(graph.targets[static_cast<std::size_t>(k)])];
        }
    }
    return directed / 2;
}

/// The parts that use each point.
std::vector<std::set<std::int32_t>> parts_of_points(const Hull<3>& hull,
                                                    const std::vector<std::int32_t>& part_of) {
    std::vector<std::set<std::int32_t>> parts(hull.points.size());
    for (std::size_t cell = 0; cell < hull.cells.size(); ++cell) {
        for (const Index v : hull.cells[cell]) {
            parts[v].insert(part_of[cell]);
        }
    }
    return parts;
}

Quality quality_of(const Hull<3>& hull, const CellGraph& graph, const std::vector<std::int32_t>& part_of,
                   int parts) {
    std::vector<std::size_t> sizes(static_cast<std::size_t>(parts));
    require(part_of.size() == hull.cells.size(), "not every cell has a part");
    for (const std::int32_t part : part_of) {
        require(part >= 0 && part < parts, "a part that there is not");
        ++sizes[static_cast<std::size_t>(part)];
    }
    require(*std::min_element(sizes.begin(), sizes.end()) > 0, "an empty part");
    Quality quality;
    quality.cut_facets = count_cut_facets(graph, part_of);
    const auto at_points = parts_of_points(hull, part_of);
    quality.shared_points = static_cast<std::size_t>(
        std::count_if(at_points.begin(), at_points.end(), [](const auto& at) { return at.size() > 1; }));
    for (std::size_t cell = 0; cell < hull.cells.size(); ++cell) {
        std::set<std::int32_t> others;
        for (const Index v : hull.cells[cell]) {
            if (at_points[v].size() > 1) {
                others.insert(at_points[v].begin(), at_points[v].end());
            }
        }
        quality.ghosts += others.empty() ? 0 : others.size() - 1;
    }
    quality.largest_part = static_cast<double>(*std::max_element(sizes.begin(), sizes.end())) * parts /
                           static_cast<double>(hull.cells.size());
    return quality;
}

void compare(const Hull<3>& hull, const char* bulk, int parts) {
    const CellGraph graph = graph_of(hull);
    std::vector<Partitioner> all{
        {"own order", [&](const CellGraph&, int n) { return by_ranges(own_order(hull), n); }},
        {"spatial curve", [&](const CellGraph&, int n) { return by_ranges(spatial_order(hull), n); }}};
    all.insert(all.end(), bench::partitioners().begin(), bench::partitioners().end());
    for (const Partitioner& partitioner : all) {
        const Stopwatch watch;
        const std::vector<std::int32_t> part_of = partitioner.part(graph, parts);
        const double seconds = watch.seconds();
        const Quality quality = quality_of(hull, graph, part_of, parts);
        const nlohmann::ordered_json line{{"bulk", bulk},
                                          {"tets", hull.cells.size()},
                                          {"points", hull.points.size()},
                                          {"parts", parts},
                                          {"by", partitioner.name},
                                          {"cut_facets", quality.cut_facets},
                                          {"shared_points", quality.shared_points},
                                          {"ghosts", quality.ghosts},
                                          {"largest_part", quality.largest_part},
                                          {"seconds", seconds}};
        std::printf("%s\n", line.dump().c_str());
        std::fflush(stdout);
    }
}

} // namespace

int main(int count, char** arguments) {
    const double millions = count > 1 ? std::atof(arguments[1]) : 1;
    std::vector<int> parts{2, 4, 16, 64};
    if (count > 2) {
        parts.clear();
        std::transform(arguments + 2, arguments + count, std::back_inserter(parts), std::atoi);
    }
    for (const auto& [bulk, name] : {std::pair{Bulk::caps, "caps"}, std::pair{Bulk::side, "side"}}) {
        const Hull<3> hull = hull_of(millions * 1e6, bulk);
        for (const int n : parts) {
            compare(hull, name, n);
        }
    }
    return 0;
}
