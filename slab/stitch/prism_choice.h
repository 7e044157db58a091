// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/stitch/prism_graph.h"
#include "slab/stitch/side_points.h"
#include "slabhull/core/array.h"
#include "slabhull/slab/stitch.h"

#include <cstdint>

namespace slabhull {

/// Layers from `first` up to `end`.
struct LayerRange {
    std::size_t first = 0;
    std::size_t end = 0;
};

/// The template of the split that each prism of some layers takes.
class PrismChoice {
public:
    PrismChoice() = default;
    PrismChoice(std::size_t facets, const LayerRange& layers, bool same_in_every_layer)
        : first_{same_in_every_layer ? 0 : layers.first}, stride_{same_in_every_layer ? 0 : facets},
          number_(same_in_every_layer ? facets : (layers.end - layers.first) * facets) {}

    std::uint8_t operator()(std::size_t layer, std::size_t facet) const {
        return number_[(layer - first_) * stride_ + facet];
    }
    std::uint8_t& at(std::size_t layer, std::size_t facet) {
        return number_[(layer - first_) * stride_ + facet];
    }

private:
    std::size_t first_ = 0;
    std::size_t stride_ = 0;
    Array<std::uint8_t> number_;
};

/// Settles every diagonal in some layers. Tracks order the columns of vertices the same way on every level
/// and in every slab; points give the shape. A diagonal by shape is the one whose four tetrahedra, two in
/// each prism beside it, have the larger smallest dihedral angle: as prisms are cones, no other tetrahedron
/// depends on it, so quadrilaterals are independent and the smallest angle of the side is the largest
/// possible. Angles within 1e-6 degrees count as equal. Cost: linear; 1 microsecond per free diagonal and
/// layer.
template<int D>
PrismChoice choose_templates(const SideOptions& options, const PrismGraph<D>& graph, const Sweep<D>& sweep,
                             const SidePoints<D>& points, const LayerRange& layers);

} // namespace slabhull
