// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The dual of a simplicial mesh as a graph for the Boost Graph Library. This is the one header that includes
/// it.

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/filter_iterator.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <boost/property_map/property_map.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace slabhull {

/// A step of the dual graph: across a facet from one cell to the next. The two directions are the same edge.
struct DualEdge {
    Index source = no_index;
    Index target = no_index;
    friend bool operator==(const DualEdge& a, const DualEdge& b) {
        return std::minmax(a.source, a.target) == std::minmax(b.source, b.target);
    }
};

/// The dual graph of D-simplices: a vertex for each cell, an edge for each facet between two cells. It is a
/// view of the neighbours alone, so that it serves boundaries of domains in the plane (D = 1: their edges)
/// and in space (D = 2: their triangles), and hulls and caps alike. The neighbours must outlive it, be in
/// range and mutual. An undirected VertexListGraph, EdgeListGraph, IncidenceGraph and AdjacencyGraph of the
/// Boost Graph Library, with a vertex_index map. Vertices are plain numbers of cells, because Boost's
/// algorithms index arrays with them.
template<int D>
class DualGraph {
    /// Which of the half-facets cell * (D + 1) + place are steps.
    struct IsStep {
        const Neighbors<D>* neighbors = nullptr;
        bool operator()(std::uint64_t h) const { return neighbors[h / (D + 1)][h % (D + 1)] != no_index; }
    };
    struct IsEdge : IsStep { ///< one of the two directions
        bool operator()(std::uint64_t h) const {
            const Index other = this->neighbors[h / (D + 1)][h % (D + 1)];
            return other != no_index && other > h / (D + 1);
        }
    };
    struct ToEdge {
        const Neighbors<D>* neighbors = nullptr;
        DualEdge operator()(std::uint64_t h) const {
            return {static_cast<Index>(h / (D + 1)), neighbors[h / (D + 1)][h % (D + 1)]};
        }
    };
    struct ToTarget {
        const Neighbors<D>* neighbors = nullptr;
        Index operator()(std::uint64_t h) const { return neighbors[h / (D + 1)][h % (D + 1)]; }
    };
    using HalfFacets = boost::counting_iterator<std::uint64_t>;
    template<class Chosen, class Map>
    using Mapped = boost::transform_iterator<Map, boost::filter_iterator<Chosen, HalfFacets>>;

public:
    using vertex_descriptor = Index;
    using edge_descriptor = DualEdge;
    using vertex_iterator = boost::counting_iterator<Index>;
    using edge_iterator = Mapped<IsEdge, ToEdge>;
    using out_edge_iterator = Mapped<IsStep, ToEdge>;
    using adjacency_iterator = Mapped<IsStep, ToTarget>;
    using vertices_size_type = std::size_t;
    using edges_size_type = std::size_t;
    using degree_size_type = std::size_t;
    using directed_category = boost::undirected_tag;
    using edge_parallel_category = boost::disallow_parallel_edge_tag;
    struct traversal_category : boost::incidence_graph_tag,
                                boost::adjacency_graph_tag,
                                boost::vertex_list_graph_tag,
                                boost::edge_list_graph_tag {};
    static vertex_descriptor null_vertex() { return no_index; }

    explicit DualGraph(std::span<const Neighbors<D>> neighbors) : neighbors_{neighbors} {}

    friend std::size_t num_vertices(const DualGraph& g) { return g.neighbors_.size(); }
    friend std::pair<vertex_iterator, vertex_iterator> vertices(const DualGraph& g) {
        return {vertex_iterator{0}, vertex_iterator{static_cast<Index>(g.neighbors_.size())}};
    }
    friend std::pair<edge_iterator, edge_iterator> edges(const DualGraph& g) {
        return g.range<edge_iterator, IsEdge, ToEdge>(0, g.neighbors_.size());
    }
    /// Linear: it counts.
    friend std::size_t num_edges(const DualGraph& g) {
        const auto [begin, end] = edges(g);
        return static_cast<std::size_t>(std::distance(begin, end));
    }
    friend std::pair<out_edge_iterator, out_edge_iterator> out_edges(Index cell, const DualGraph& g) {
        return g.range<out_edge_iterator, IsStep, ToEdge>(cell, cell + std::size_t{1});
    }
    friend std::size_t out_degree(Index cell, const DualGraph& g) {
        const Neighbors<D>& across = g.neighbors_[cell];
        return across.size() - static_cast<std::size_t>(std::count(across.begin(), across.end(), no_index));
    }
    friend std::pair<adjacency_iterator, adjacency_iterator> adjacent_vertices(Index cell,
                                                                               const DualGraph& g) {
        return g.range<adjacency_iterator, IsStep, ToTarget>(cell, cell + std::size_t{1});
    }
    friend Index source(const DualEdge& e, const DualGraph&) { return e.source; }
    friend Index target(const DualEdge& e, const DualGraph&) { return e.target; }

    friend boost::typed_identity_property_map<Index> get(boost::vertex_index_t, const DualGraph&) {
        return {};
    }
    friend Index get(boost::vertex_index_t, const DualGraph&, Index cell) { return cell; }

private:
    /// The half-facets of cells [begin, end) that are chosen, mapped.
    template<class Iterator, class Chosen, class Map>
    std::pair<Iterator, Iterator> range(std::size_t begin, std::size_t end) const {
        const HalfFacets first{std::uint64_t{begin} * (D + 1)};
        const HalfFacets last{std::uint64_t{end} * (D + 1)};
        Chosen chosen;
        chosen.neighbors = neighbors_.data();
        const Map map{neighbors_.data()};
        return {Iterator{{chosen, first, last}, map}, Iterator{{chosen, last, last}, map}};
    }

    std::span<const Neighbors<D>> neighbors_;
};

} // namespace slabhull

/// @cond Doxygen looks for Boost's own template.
/// Tells Boost the type of get(vertex_index, graph).
template<int D>
struct boost::property_map<slabhull::DualGraph<D>, boost::vertex_index_t> {
    using type = boost::typed_identity_property_map<slabhull::Index>;
    using const_type = type;
};
/// @endcond
