// SPDX-License-Identifier: BSD-3-Clause
#include "slab/stitch/prism_graph.h"

#include "slabhull/core/parallel.h"
#include "slabhull/topology/halfedge_mesh.h"
#include "slabhull/topology/matching.h"

#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t facets_per_piece = 1 << 14;

template<int D>
Array<std::array<typename PrismGraph<D>::TwinFace, D>> twin_faces(const Boundary<D>& boundary) {
    Array<std::array<typename PrismGraph<D>::TwinFace, D>> twins(boundary.facet_count());
    parallel_for(twins.size(), facets_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t i = 0; i < D; ++i) {
                const TwinFacet twin = boundary.twin(f, i);
                bool turned = false;
                if constexpr (D == 3) {
                    turned = boundary.facets()[f][quad_corners<3>(i)[0]] !=
                             boundary.facets()[twin.facet][quad_corners<3>(twin.corner)[0]];
                }
                twins[f][i] = {twin.corner, turned};
            }
        }
    });
    return twins;
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

/// D = 3: quadrilaterals with a centre come first; either kind is in the order of the boundary's edges.
void number_quads(const SplitRecipe& recipe, PrismGraph<3>& graph) {
    const HalfedgeMesh& mesh = graph.boundary.mesh();
    const Array<Index> partner =
        recipe.pairs() ? perfect_matching(graph.boundary.neighbors()) : Array<Index>{};
    std::vector<Index> number(mesh.edge_count());
    const auto centred = [&](EdgeId edge) {
        const auto [a, b] = mesh.facets(edge);
        const bool shared = !recipe.pairs() || partner[a.slot()] == b.slot();
        return (shared ? recipe.shared : recipe.others) == SplitRecipe::Carries::centre;
    };
    for (const bool with_centre : {true, false}) {
        for (const EdgeId edge : mesh.edges()) {
            if (centred(edge) == with_centre) {
                number[edge.slot()] = static_cast<Index>(graph.quads++);
            }
        }
        graph.centred = with_centre ? graph.quads : graph.centred;
    }
    graph.quad.resize(graph.facets());
    for (const FacetId facet : mesh.facets()) {
        const auto around = mesh.halfedges(facet);
        for (std::size_t i = 0; i < 3; ++i) { // edge i is opposite to corner i
            graph.quad[facet.slot()][i] = number[mesh.edge(around[(i + 1) % 3]).slot()];
        }
    }
}

} // namespace

template<int D>
PrismGraph<D> connect_prisms(const Boundary<D>& boundary, const SplitRecipe& recipe) {
    PrismGraph<D> graph;
    graph.boundary = boundary;
    graph.twin = twin_faces<D>(boundary);
    number_quads(recipe, graph);
    return graph;
}

template PrismGraph<2> connect_prisms<2>(const Boundary<2>&, const SplitRecipe&);
template PrismGraph<3> connect_prisms<3>(const Boundary<3>&, const SplitRecipe&);

} // namespace slabhull
