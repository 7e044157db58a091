// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/stitch/side_vertices.h"
#include "slabhull/core/array.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace slabhull {

template<int D>
Point<D + 1> at_time(const Point<D>& x, double t) {
    Point<D + 1> point;
    std::copy(x.begin(), x.end(), point.begin());
    point[D] = t;
    return point;
}

/// Where the side's vertices are: what the sweep says, and means of its corners for the centres of the split.
/// What it is made from must outlive it.
template<int D>
class SidePoints {
public:
    SidePoints(const Sweep<D>& sweep, const PrismGraph<D>& graph, const SideVertices<D>& vertices)
        : sweep_{sweep}, vertices_{vertices} {
        ends_.resize(vertices.has_face_centres() ? graph.centred : 0);
        for (std::size_t facet = 0; facet < graph.facets() && !ends_.empty(); ++facet) {
            for (std::size_t q = 0; q < PrismGraph<D>::quads_of_facet; ++q) {
                if (graph.owns(facet, q) && graph.is_centred(facet, q)) {
                    const auto [j, k] = quad_corners<D>(q);
                    const auto& corners = sweep.boundary.facets()[facet];
                    ends_[graph.quad[facet][q]] = {corners[j], corners[k]};
                }
            }
        }
    }

    Point<D + 1> on_level(std::size_t level, Index v) const {
        return at_time<D>(sweep_.places(level)[v], sweep_.times[level]);
    }
    /// Of a quadrilateral that has a centre.
    Point<D + 1> face_centre(std::size_t layer, Index quad) const {
        return mean_of_columns(layer, ends_[quad]);
    }
    Point<D + 1> prism_centre(std::size_t layer, std::size_t facet) const {
        return mean_of_columns(layer, sweep_.boundary.facets()[facet]);
    }

    /// The point of a vertex of the hull that is in neither cap.
    Point<D + 1> of_vertex(std::size_t vertex) const {
        const auto [layer, kind, number] = vertices_.place_of(vertex);
        switch (kind) {
        case SideVertex::on_level:
            return on_level(layer, static_cast<Index>(number));
        case SideVertex::face_centre:
            return face_centre(layer, static_cast<Index>(number));
        case SideVertex::prism_centre:
            break;
        }
        return prism_centre(layer, number);
    }

private:
    /// Mean of the points that swept vertices have below and above a layer.
    template<std::size_t N>
    Point<D + 1> mean_of_columns(std::size_t layer, const std::array<Index, N>& vertices) const {
        Point<D> sum{};
        for (const std::size_t level : {layer, layer + 1}) {
            const Array<Point<D>>& places = sweep_.places(level);
            for (const Index v : vertices) {
                for (std::size_t k = 0; k < D; ++k) {
                    sum[k] += places[v][k];
                }
            }
        }
        for (double& coordinate : sum) {
            coordinate /= 2.0 * static_cast<double>(N);
        }
        return at_time<D>(sum, 0.5 * (sweep_.times[layer] + sweep_.times[layer + 1]));
    }

    const Sweep<D>& sweep_;
    const SideVertices<D>& vertices_;
    Array<std::array<Index, 2>> ends_; ///< of each quadrilateral with a centre, as its owner has them
};

} // namespace slabhull
