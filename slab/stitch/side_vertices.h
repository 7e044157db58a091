// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/stitch/prism_graph.h"
#include "slabhull/slab/sweep.h"

#include <array>

namespace slabhull {

/// Kinds of vertices that the side adds.
enum class SideVertex { on_level, face_centre, prism_centre };

/// Numbers of the hull's vertices: those of the initial cap; then, layer by layer, the vertices of the level
/// below the layer (except the first level), the centres of quadrilaterals, and those of prisms; then the
/// terminating cap's, the swept ones first.
template<int D>
class SideVertices {
public:
    SideVertices(std::size_t initial_points, const Sweep<D>& sweep, const PrismGraph<D>& graph,
                 const SplitRecipe& recipe)
        : sweep_{sweep}, graph_{graph}, begin_{initial_points}, boundary_{sweep.boundary.vertex_count()},
          face_centres_{D == 3 ? graph.centred : 0},
          prism_centres_{recipe.apex == SplitRecipe::Apex::prism_centre ? graph.facets() : 0} {}

    std::size_t begin() const { return begin_; }
    /// One past the side's vertices: the first of the terminating cap.
    std::size_t end() const {
        return begin_ + sweep_.layers() * (face_centres_ + prism_centres_) +
               (sweep_.layers() - 1) * boundary_;
    }
    std::size_t on_level(std::size_t level, Index v) const {
        if (level == 0) {
            return sweep_.boundary.mesh_vertices()[v];
        }
        return level == sweep_.layers() ? end() + v : layer_begin(level) - boundary_ + v;
    }
    std::size_t face_centre(std::size_t layer, Index quad) const { return layer_begin(layer) + quad; }
    std::size_t prism_centre(std::size_t layer, std::size_t facet) const {
        return layer_begin(layer) + face_centres_ + facet;
    }
    /// What a vertex is that is in neither cap: on level, or centre in layer, `layer`; its number among
    /// these.
    struct Place {
        std::size_t layer;
        SideVertex kind;
        std::size_t number;
    };
    Place place_of(std::size_t vertex) const {
        const std::size_t centres = face_centres_ + prism_centres_;
        const std::size_t shifted = vertex - begin_ + boundary_; // as if level 0 were the side's, too
        const std::size_t layer = shifted / (centres + boundary_);
        const std::size_t number = shifted % (centres + boundary_);
        if (number < boundary_) {
            return {layer, SideVertex::on_level, number};
        }
        return number < boundary_ + face_centres_
                   ? Place{layer, SideVertex::face_centre, number - boundary_}
                   : Place{layer, SideVertex::prism_centre, number - boundary_ - face_centres_};
    }
    bool has_face_centres() const { return face_centres_ > 0; }
    bool has_prism_centres() const { return prism_centres_ > 0; }

    /// The points of a prism, in the order of PrismPoint; any number where the split has none.
    std::array<Index, PrismPoint<D>::count> of_prism(std::size_t layer, std::size_t facet) const {
        std::array<Index, PrismPoint<D>::count> points{};
        const auto put = [&points](int local, std::size_t vertex) {
            points[static_cast<std::size_t>(local)] = static_cast<Index>(vertex);
        };
        for (int i = 0; i < D; ++i) {
            const Index v = sweep_.boundary.facets()[facet][static_cast<std::size_t>(i)];
            put(PrismPoint<D>::bottom(i), on_level(layer, v));
            put(PrismPoint<D>::top(i), on_level(layer + 1, v));
            if constexpr (D == 3) {
                put(PrismPoint<D>::face_centre(i),
                    face_centre(layer, graph_.quad[facet][static_cast<std::size_t>(i)]));
            }
        }
        put(PrismPoint<D>::centre, prism_centre(layer, facet));
        return points;
    }

private:
    /// First centre of a layer; the vertices of the level below it come just before.
    std::size_t layer_begin(std::size_t layer) const {
        return begin_ + layer * (face_centres_ + prism_centres_ + boundary_);
    }

    const Sweep<D>& sweep_;
    const PrismGraph<D>& graph_;
    std::size_t begin_;
    std::size_t boundary_;
    std::size_t face_centres_;
    std::size_t prism_centres_;
};

} // namespace slabhull
