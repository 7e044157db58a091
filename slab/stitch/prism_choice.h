// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/stitch/prism_graph.h"
#include "slab/stitch/side_vertices.h"
#include "slabhull/core/array.h"
#include "slabhull/slab/stitch.h"

#include <span>

namespace slabhull {

/// The template of the split that each prism takes.
class PrismChoice {
public:
    PrismChoice() = default;
    PrismChoice(std::size_t facets, std::size_t layers, bool same_in_every_layer)
        : stride_{same_in_every_layer ? 0 : facets}, number_(same_in_every_layer ? facets : layers * facets) {
    }

    std::uint8_t operator()(std::size_t layer, std::size_t facet) const {
        return number_[layer * stride_ + facet];
    }
    std::uint8_t& at(std::size_t layer, std::size_t facet) { return number_[layer * stride_ + facet]; }

private:
    std::size_t stride_ = 0;
    Array<std::uint8_t> number_;
};

/// The data that decide diagonals. Tracks order the columns of vertices the same way on every level and in
/// every slab; the hull's points give the shape.
template<int D>
struct DiagonalFacts {
    const Sweep<D>& sweep;
    const SideVertices<D>& vertices;
    std::span<const Point<D + 1>> points; ///< of the hull
};

/// Settles every diagonal. A diagonal by shape is the one whose four tetrahedra, two in each prism beside it,
/// have the larger smallest dihedral angle: as prisms are cones, no other tetrahedron depends on it, so
/// quadrilaterals are independent and the smallest angle of the side is the largest possible. Angles within
/// 1e-6 degrees count as equal. Cost: linear; 1 microsecond per free diagonal and layer.
template<int D>
PrismChoice choose_templates(const SideOptions& options, const PrismGraph<D>& graph,
                             const DiagonalFacts<D>& facts);

} // namespace slabhull
