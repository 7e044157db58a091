// SPDX-License-Identifier: BSD-3-Clause
// Minimum cut by Boost.Graph: Y. Boykov, V. Kolmogorov, IEEE PAMI 26(9), 2004.
#include "geometry/meshing/surface_division.h"

#include "geometry/basics/vector_algebra.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

#include <cmath>
#include <cstdint>

namespace slabhull {

namespace {

/// Facets may go to either side if their centre is at most this many spacings from the plane.
constexpr double free_height = 1.6;
/// Cost of an edge at height h, in spacings, relative to one in the plane: 1 + pull h^2. Small enough not to
/// prefer two sides of a triangle to the third, or a zigzag to a grid line half a spacing away.
constexpr double pull = 0.4;
/// Costs are rounded to integers, so that the cut is the same on all machines.
constexpr double cost_unit = 1e6;

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Flow = std::int64_t;
using NodeProperties = boost::property<boost::vertex_color_t, boost::default_color_type,
                                       boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor,
                                                       boost::property<boost::vertex_distance_t, Flow>>>;
using EdgeProperties =
    boost::property<boost::edge_capacity_t, Flow,
                    boost::property<boost::edge_residual_capacity_t, Flow,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>;
using FlowGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, NodeProperties, EdgeProperties>;

class Divider {
public:
    Divider(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
            std::span<const double> height, std::span<const double> spacing)
        : surface_{surface}, neighbors_{neighbors}, height_{height}, spacing_{spacing} {}

    std::vector<char> run() {
        above_.resize(surface_.facets.size());
        node_.assign(surface_.facets.size(), no_index);
        for (Index f = 0; f < surface_.facets.size(); ++f) {
            const double middle = mean_height(f);
            above_[f] = middle > 0 ? 1 : 0;
            if (std::abs(middle) < free_height) {
                node_[f] = static_cast<Index>(free_.size());
                free_.push_back(f);
            }
        }
        cut();
        return std::move(above_);
    }

private:
    /// Mean height of a facet, in spacings.
    double mean_height(Index f) const {
        double sum = 0;
        for (const Index v : surface_.facets[f]) {
            sum += height_[v] / spacing_[v];
        }
        return sum / 3;
    }

    void cut() {
        const std::size_t up = free_.size();
        const std::size_t down = up + 1;
        FlowGraph graph(free_.size() + 2);
        for (std::size_t node = 0; node < free_.size(); ++node) {
            const Index f = free_[node];
            for (std::size_t i = 0; i < 3; ++i) {
                const Index across = neighbors_[f][i];
                const Flow price = cost(f, i);
                if (node_[across] == no_index) {
                    connect(graph, node, above_[across] != 0 ? up : down, price);
                } else if (node_[across] > node) {
                    connect(graph, node, node_[across], price);
                }
            }
        }
        boost::boykov_kolmogorov_max_flow(graph, up, down);
        const auto color = boost::get(boost::vertex_color, graph);
        for (std::size_t node = 0; node < free_.size(); ++node) {
            above_[free_[node]] = color[node] == color[up] ? 1 : 0;
        }
    }

    static void connect(FlowGraph& graph, std::size_t a, std::size_t b, Flow price) {
        const auto there = boost::add_edge(a, b, graph).first;
        const auto back = boost::add_edge(b, a, graph).first;
        const auto capacity = boost::get(boost::edge_capacity, graph);
        const auto reverse = boost::get(boost::edge_reverse, graph);
        capacity[there] = price;
        capacity[back] = price;
        reverse[there] = back;
        reverse[back] = there;
    }

    Flow cost(Index f, std::size_t i) const {
        const Index a = surface_.facets[f][(i + 1) % 3];
        const Index b = surface_.facets[f][(i + 2) % 3];
        const double spacing = (spacing_[a] + spacing_[b]) / 2;
        const double height = (height_[a] + height_[b]) / 2 / spacing;
        const double length = norm(minus(surface_.points[a], surface_.points[b])) / spacing;
        return static_cast<Flow>(cost_unit * length * (1 + pull * height * height)) + 1;
    }

    const Surface<3>& surface_;
    std::span<const Neighbors<2>> neighbors_;
    std::span<const double> height_;
    std::span<const double> spacing_;
    std::vector<char> above_;
    std::vector<Index> node_; ///< node of each facet in the graph; no_index if it is not free
    std::vector<Index> free_; ///< the facet of each node
};

} // namespace

std::vector<char> divide_surface(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                                 std::span<const double> height, std::span<const double> spacing) {
    return Divider{surface, neighbors, height, spacing}.run();
}

Array<Facet<2>> edges_between(const Surface<3>& surface, std::span<const Neighbors<2>> neighbors,
                              const std::vector<char>& above) {
    Array<Facet<2>> edges;
    for (Index f = 0; f < surface.facets.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (above[f] == 0 && above[neighbors[f][i]] != 0) {
                edges.push_back({surface.facets[f][(i + 1) % 3], surface.facets[f][(i + 2) % 3]});
            }
        }
    }
    return edges;
}

} // namespace slabhull
