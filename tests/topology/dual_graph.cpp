// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/dual_graph.h"

#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/manifold.h"
#include "topology/specimens.h"

#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/graph_concepts.hpp>
#include <boost/graph/max_cardinality_matching.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <queue>
#include <set>
#include <vector>

using namespace slabhull;
using specimens::Complex;

namespace {

/// Boost's concepts, checked while compiling.
template<class Graph>
struct SatisfiesBoost {
    BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<Graph>));
    BOOST_CONCEPT_ASSERT((boost::EdgeListGraphConcept<Graph>));
    BOOST_CONCEPT_ASSERT((boost::IncidenceGraphConcept<Graph>));
    BOOST_CONCEPT_ASSERT((boost::AdjacencyGraphConcept<Graph>));
    BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<Graph, Index, boost::vertex_index_t>));
};
template struct SatisfiesBoost<DualGraph<1>>;
template struct SatisfiesBoost<DualGraph<2>>;
template struct SatisfiesBoost<DualGraph<3>>;

template<int D>
Array<Neighbors<D>> neighbors_of(const Complex<D>& complex) {
    return build_adjacency<D>(complex.cells, complex.vertices).neighbors;
}

template<int D>
std::vector<Complex<D>> complexes_with_graphs() {
    using namespace specimens;
    Complex<D> holed = torus<D>(3);
    holed.cells.erase(holed.cells.begin() + 3, holed.cells.begin() + 8);
    return {sphere<D>(), torus<D>(4), holed, disjoint_union(disjoint_union(sphere<D>(), torus<D>(3)), holed)};
}

template<int D>
void require_graph_right(const Array<Neighbors<D>>& neighbors) {
    const DualGraph<D> graph{neighbors};
    REQUIRE(num_vertices(graph) == neighbors.size());
    std::multiset<std::pair<Index, Index>> expected;
    for (Index c = 0; c < neighbors.size(); ++c) {
        std::multiset<Index> across;
        for (const Index n : neighbors[c]) {
            if (n != no_index) {
                across.insert(n);
                expected.insert(std::minmax(c, n));
            }
        }
        REQUIRE(out_degree(c, graph) == across.size());
        const auto [begin, end] = adjacent_vertices(c, graph);
        REQUIRE(std::multiset<Index>(begin, end) == across);
        for (auto [e, last] = out_edges(c, graph); e != last; ++e) {
            REQUIRE(source(*e, graph) == c);
            REQUIRE(across.contains(target(*e, graph)));
            REQUIRE(*e == DualEdge{target(*e, graph), c});
        }
    }
    std::multiset<std::pair<Index, Index>> found;
    for (auto [e, last] = edges(graph); e != last; ++e) {
        found.insert({(*e).source, (*e).target});
        found.insert({(*e).source, (*e).target}); // once for each direction
    }
    REQUIRE(found == expected);
    REQUIRE(2 * num_edges(graph) == expected.size());
}

/// Distances from cell 0 in steps across facets, no_index where it does not lead.
template<int D>
std::vector<Index> distances(const Array<Neighbors<D>>& neighbors) {
    std::vector<Index> result(neighbors.size(), no_index);
    result[0] = 0;
    std::queue<Index> waiting{{0}};
    for (; !waiting.empty(); waiting.pop()) {
        for (const Index n : neighbors[waiting.front()]) {
            if (n != no_index && result[n] == no_index) {
                result[n] = result[waiting.front()] + 1;
                waiting.push(n);
            }
        }
    }
    return result;
}

template<int D>
std::vector<Index> distances_by_boost(const DualGraph<D>& graph) {
    std::vector<Index> result(num_vertices(graph), no_index);
    result[0] = 0;
    auto* places = result.data();
    boost::breadth_first_search(
        graph, Index{0},
        boost::visitor(boost::make_bfs_visitor(boost::record_distances(places, boost::on_tree_edge{}))));
    return result;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the dual graph has the cells for vertices and the facets between them for edges", "",
                       ((int D), D), 1, 2, 3) {
    if constexpr (D == 1) {
        require_graph_right<1>(
            build_adjacency<1>(Array<Simplex<1>>{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}}, 7)
                .neighbors);
    } else {
        for (const Complex<D>& complex : complexes_with_graphs<D>()) {
            require_graph_right<D>(neighbors_of(complex));
        }
    }
}

TEMPLATE_TEST_CASE_SIG("Boost's algorithms run on it and agree with ours", "", ((int D), D), 2, 3) {
    for (const Complex<D>& complex : complexes_with_graphs<D>()) {
        const auto neighbors = neighbors_of(complex);
        const DualGraph<D> graph{neighbors};
        std::vector<Index> component(neighbors.size());
        const auto components = boost::connected_components(graph, component.data());
        CHECK(static_cast<std::size_t>(components) == count_components<D>(neighbors));
        CHECK(distances_by_boost(graph) == distances<D>(neighbors));
    }
}

TEST_CASE("the dual of a closed surface has a perfect matching, as Petersen's theorem says") {
    const auto neighbors = neighbors_of(specimens::refined(specimens::torus<2>(4)));
    const DualGraph<2> graph{neighbors};
    std::vector<Index> mate(neighbors.size());
    boost::edmonds_maximum_cardinality_matching(graph, mate.data());
    CHECK(boost::matching_size(graph, mate.data()) == neighbors.size() / 2);
}
