// SPDX-License-Identifier: BSD-3-Clause
#include "slab/stitch/prism_graph.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/matching.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

constexpr std::size_t facets_per_piece = 1 << 14;

template<int D>
Array<Neighbors<D - 1>> facet_neighbors(const Surface<D>& surface) {
    auto adjacency = build_adjacency<D - 1>(surface.facets, surface.points.size());
    if (!adjacency.defects.empty()) {
        const auto& first = adjacency.defects.front();
        std::vector<Entity> entities;
        for (const Index v : first.facet) {
            entities.push_back({"vertex", v, {}});
        }
        throw GeometryError(
            fmt::format("the swept boundary is not a closed manifold: {} of its {} are not in exactly two "
                        "agreeing facets; the first is that of boundary vertices {}, in {} facets",
                        adjacency.defects.size(), D == 3 ? "edges" : "vertices", fmt::join(first.facet, ", "),
                        first.cells.size()),
            std::move(entities));
    }
    return std::move(adjacency.neighbors);
}

template<int D>
typename PrismGraph<D>::Door door_between(const Facet<D>& here, std::size_t face, const Facet<D>& there) {
    std::size_t other = 0; // the corner of the facet across that is not shared
    for (std::size_t i = 0; i < D; ++i) {
        if (std::find(here.begin(), here.end(), there[i]) == here.end()) {
            other = i;
        }
    }
    bool turned = false;
    if constexpr (D == 3) {
        turned = here[quad_corners<3>(face)[0]] != there[quad_corners<3>(other)[0]];
    }
    return {static_cast<std::uint8_t>(other), turned};
}

template<int D>
void open_doors(const Surface<D>& surface, PrismGraph<D>& graph) {
    graph.door.resize(graph.facets());
    parallel_for(graph.facets(), facets_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                graph.door[f][i] = door_between<D>(surface.facets[f], i, surface.facets[graph.across[f][i]]);
            }
        }
    });
}

/// D = 2: a quadrilateral for each facet.
void number_quads(const SplitRecipe& recipe, PrismGraph<2>& graph) {
    graph.quad.resize(graph.facets());
    for (Index f = 0; f < graph.facets(); ++f) {
        graph.quad[f] = {f};
    }
    graph.quads = graph.facets();
    graph.centred = recipe.shared == SplitRecipe::Carries::centre ? graph.quads : 0;
}

/// D = 3: in the order of the facets that own them, the centred ones before all others.
void number_quads(const SplitRecipe& recipe, PrismGraph<3>& graph) {
    const Array<Index> partner = recipe.pairs() ? perfect_matching(graph.across) : Array<Index>{};
    const auto centred = [&](std::size_t f, std::size_t i) {
        const bool shared = !recipe.pairs() || partner[f] == graph.across[f][i];
        return (shared ? recipe.shared : recipe.others) == SplitRecipe::Carries::centre;
    };
    const auto each_owned = [&](const auto& visit) {
        for (std::size_t f = 0; f < graph.facets(); ++f) {
            for (std::size_t i = 0; i < 3; ++i) {
                if (graph.owns(f, i)) {
                    visit(f, i, centred(f, i));
                }
            }
        }
    };
    each_owned([&](std::size_t, std::size_t, bool has_centre) { graph.centred += has_centre ? 1 : 0; });
    graph.quad.resize(graph.facets());
    std::array<std::size_t, 2> next{graph.centred, 0};
    each_owned([&](std::size_t f, std::size_t i, bool has_centre) {
        const auto number = static_cast<Index>(next[has_centre ? 1 : 0]++);
        graph.quad[f][i] = number;
        graph.quad[graph.across[f][i]][graph.door[f][i].face] = number;
    });
    graph.quads = next[0];
}

} // namespace

template<int D>
PrismGraph<D> connect_prisms(const Surface<D>& surface, const SplitRecipe& recipe) {
    PrismGraph<D> graph;
    graph.across = facet_neighbors<D>(surface);
    open_doors<D>(surface, graph);
    number_quads(recipe, graph);
    return graph;
}

template PrismGraph<2> connect_prisms<2>(const Surface<2>&, const SplitRecipe&);
template PrismGraph<3> connect_prisms<3>(const Surface<3>&, const SplitRecipe&);

} // namespace slabhull
